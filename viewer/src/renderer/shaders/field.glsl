// Reads a field of values and states (fields/flat_field.ts). State 4 is a place beyond the grid, and state 5 is
// ambiguous.
uniform sampler2D field; // value, state
uniform bool mixes;

// Returns value and state at a place in texels.
vec2 fieldAt(vec2 place) {
    // Take the nearest texel if values do not mix, or if the place is beyond the grid.
    ivec2 most = textureSize(field, 0) - 1;
    vec2 nearest = texelFetch(field, clamp(ivec2(floor(place)), ivec2(0), most), 0).rg;
    if (!mixes || nearest.y == 4.0) return nearest;
    // Add up the weights of each state among the four texels about the place, and the weighted values.
    vec2 low = floor(place - 0.5), share = place - 0.5 - low;
    vec4 weights = vec4(0.0);
    float sum = 0.0, ambiguous = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 side = ivec2(i & 1, i >> 1);
        vec2 one = texelFetch(field, clamp(ivec2(low) + side, ivec2(0), most), 0).rg;
        float weight = (side.x == 1 ? share.x : 1.0 - share.x) * (side.y == 1 ? share.y : 1.0 - share.y);
        if (one.y < 0.5) weights.x += weight;
        else if (one.y < 1.5) weights.y += weight;
        else if (one.y < 2.5) weights.z += weight;
        else if (one.y < 3.5) { weights.w += weight; sum += weight * one.x; }
        else if (one.y > 4.5) ambiguous += weight;
    }
    // Choose the state by the status rule (fields/status_rule.ts). A value is the mean of the texels with values.
    float unknown = weights.z + ambiguous;
    if (weights.x > weights.y + unknown + weights.w) return vec2(0.0, 0.0);
    if (unknown > weights.w && unknown > weights.y) return vec2(0.0, weights.z >= ambiguous ? 2.0 : 5.0);
    if (weights.w < weights.y || weights.w == 0.0) return vec2(0.0, 1.0);
    return vec2(sum / weights.w, 3.0);
}
