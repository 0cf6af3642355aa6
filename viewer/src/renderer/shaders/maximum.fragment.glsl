// Draws the maxima of columns on the ground.
uniform vec3 seenColor, foldedColor;
uniform vec2 halfSize; // half of the grid's width and height, in meters
uniform vec4 extent; // sides of the field: west, south, east, north
uniform float ground;
out vec4 color;
void main() {
    // Find where the ray meets the ground, and that place in the field.
    vec3 start = rayStart(), along = rayStep();
    float depth = (ground - start.z) / along.z;
    if (missesGround(along, depth)) discard;
    vec2 on = (start + depth * along).xy;
    vec2 place = (on - extent.xy) / (extent.zw - extent.xy);
    if (any(greaterThanEqual(abs(on), halfSize))) discard;
    if (any(lessThan(place, vec2(0.0))) || any(greaterThanEqual(place, vec2(1.0)))) discard;
    // Cover the ground where there is a value or range folded air, and hatch it where echo is ambiguous. Elsewhere the
    // ground stays visible.
    vec2 found = fieldAt(place * vec2(textureSize(field, 0)));
    int state = int(found.y + 0.5);
    if (state == 2) color = vec4(foldedColor, 1.0);
    else if (state == 5) color = vec4(foldedColor, 1.0) * hatchAt(1.0);
    else if (state == 3) {
        vec4 look = lookOf(found.x);
        if (look.a == 0.0) discard;
        color = vec4(mix(seenColor, look.rgb, look.a), 1.0);
    } else discard;
}
