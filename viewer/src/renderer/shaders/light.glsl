// Computes the light in the volume from the texture of falls (fields/falls.ts).
uniform sampler3D falls; // its axes are z, y, x
uniform vec2 fallsFirst, fallsCells; // where the texture begins, and its size, in cells of the grid
uniform vec3 perM; // turns falls into slopes per meter of drawn space

// Returns the factor of the light at a cell.
float lightAt(vec3 cell, vec3 looks) {
    // Read the fall of values. The texture has signed square roots, so that gentle falls have fine steps.
    vec2 across = (cell.xy + 0.5 - fallsFirst) / fallsCells;
    vec4 found = texture(falls, vec3((cell.z + 0.5) / cells.z, across.y, across.x));
    vec3 root = (255.0 * found.xyz - 128.0) / 127.0;
    vec3 slope = root * abs(root) * STEEPEST_FALL * perM;
    // Light steep falls as a surface. Hardly light gentle falls, because their direction is noise.
    float steep = length(slope);
    return mix(1.0, facing(slope, steep / (steep + 1.5e-3), looks), found.a);
}
