// A solid thing: its color, and its depth as a share of the grid's depths.
uniform vec3 seenColor, foldedColor, hatchColor, borderColor;
uniform vec2 depthRange;
in vec2 at;
in float away;
out vec4 color;

// Returns the color of a state and a value; clear air leaves the pixel to what is behind.
vec3 solidColor(int state, float value) {
    if (state == 2) return foldedColor;
    // Hatch what was not seen with lines of the picture, and let what is behind be seen between them.
    if (state == 0) {
        vec2 p = floor(pixel());
        if (mod(p.x + p.y, 9.0) >= 1.5) discard;
        return hatchColor;
    }
    if (state != 3) discard;
    // Blend the value's color over that of air that was seen, because what is solid has no opacity of its own.
    vec4 look = lookOf(value);
    if (look.a == 0.0) discard;
    return mix(seenColor, look.rgb, look.a);
}

// Puts a color that may lie before the grid or behind it: there it is as near and as far as the grid's edges.
void putAnywhere(vec3 rgb) {
    color = vec4(rgb, 1.0);
    gl_FragDepth = clamp((away - depthRange.x) / (depthRange.y - depthRange.x), 0.0, 0.999999);
}
void put(vec3 rgb) {
    if (away < depthRange.x) discard;
    putAnywhere(rgb);
}
