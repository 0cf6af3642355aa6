// The factor of the light in the volume, from the texture of falls (fields/falls.ts).
uniform sampler3D falls; // along z, y, x
uniform vec2 fallsFirst, fallsCells; // where it begins, and how far it reaches, in cells of the grid
uniform vec3 perM; // of drawn space

float lightAt(vec3 cell, vec3 looks) {
    // Read the fall of values, whose root is kept with a sign so that gentle falls have fine steps.
    vec2 across = (cell.xy + 0.5 - fallsFirst) / fallsCells;
    vec4 found = texture(falls, vec3((cell.z + 0.5) / cells.z, across.y, across.x));
    vec3 root = (255.0 * found.xyz - 128.0) / 127.0;
    vec3 slope = root * abs(root) * STEEPEST_FALL * perM;
    // Light steep falls as a surface, and leave gentle ones alone, where a direction would be noise.
    float steep = length(slope);
    return mix(1.0, facing(slope, steep / (steep + 1.5e-3), looks), found.a);
}
