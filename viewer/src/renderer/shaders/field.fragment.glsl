// Draws a plane or a section, which is a field with a border of 1.25 pixels.
void main() {
    vec2 extent = vec2(textureSize(field, 0));
    vec2 border = min(at, extent - at) / fwidth(at);
    if (min(border.x, border.y) < 1.25) {
        put(borderColor);
        return;
    }
    vec2 found = fieldAt(at);
    if (found.y == 4.0) discard;
    put(solidColor(int(found.y + 0.5), found.x));
}
