// Writes the color of a solid layer, and its depth as a share of the grid's depths.
uniform vec3 seenColor, foldedColor, hatchColor, borderColor;
uniform vec2 depthRange;
in vec2 at;
in float away;
out vec4 color;

// Returns the color of a state and a value. Discards the pixel for clear air, so that the background stays visible.
vec3 solidColor(int state, float value) {
    if (state == 2) return foldedColor;
    // Hatch air that was not seen. The background is visible between the lines.
    if (state == 0) {
        vec2 p = floor(pixel());
        if (mod(p.x + p.y, 9.0) >= 1.5) discard;
        return hatchColor;
    }
    // Hatch ambiguous echo in the color of range folded air.
    if (state == 5) {
        float share = hatchAt(1.0);
        if (share == 0.0) discard;
        return mix(seenColor, foldedColor, share);
    }
    if (state != 3) discard;
    // Blend the color of the value over the color of seen air, because a solid layer is opaque.
    vec4 look = lookOf(value);
    if (look.a == 0.0) discard;
    return mix(seenColor, look.rgb, look.a);
}

// Writes a color at any depth. Depths before or behind the grid are clamped to the depths of the grid.
void putAnywhere(vec3 rgb) {
    color = vec4(rgb, 1.0);
    gl_FragDepth = clamp((away - depthRange.x) / (depthRange.y - depthRange.x), 0.0, 0.999999);
}
void put(vec3 rgb) {
    if (away < depthRange.x) discard;
    putAnywhere(rgb);
}
