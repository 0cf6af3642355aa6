// Makes sides of a surface lighter that face the sun, and edges that are seen along the surface.
uniform vec3 sun; // its direction

// Returns the factor of the light. `slope` is how the surface falls, and `share` how much all this counts.
float facing(vec3 slope, float share, vec3 looks) {
    float steep = length(slope);
    vec3 outward = slope / max(steep, 1e-12);
    float aside = 1.0 - min(1.0, abs(dot(outward, looks)));
    return 1.0 + share * (0.4 * dot(outward, sun) + 0.25 * aside * aside * aside);
}
