// Looks up the color of a value, or of a code (tables/looks.ts).
uniform sampler2D looks;
uniform vec2 lookLine; // entry = x + y * value
vec4 lookOf(float value) {
    int entry = int(clamp(floor(lookLine.x + lookLine.y * value), 0.0, float(LOOK_COUNT - 1)));
    return texelFetch(looks, ivec2(entry % LOOK_COLUMNS, entry / LOOK_COLUMNS), 0);
}
