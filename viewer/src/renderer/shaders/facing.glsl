// Makes a surface lighter where it faces the sun, and at edges where it is seen from the side.
uniform vec3 sun; // direction of the sun

// Returns the factor of the light. `slope` points in the direction in which values fall, `share` is the weight of the
// effect from 0 to 1, and `looks` is the direction of the ray.
float facing(vec3 slope, float share, vec3 looks) {
    float steep = length(slope);
    vec3 outward = slope / max(steep, 1e-12);
    float aside = 1.0 - min(1.0, abs(dot(outward, looks)));
    return 1.0 + share * (0.4 * dot(outward, sun) + 0.25 * aside * aside * aside);
}
