// Draws a line whose edges fade over one pixel.
uniform vec4 look;
uniform float width;
in float off; // distance from the middle of the line, in pixels
out vec4 color;
void main() {
    float cover = clamp(0.5 * width + 0.5 - abs(off), 0.0, 1.0);
    color = vec4(look.rgb, 1.0) * look.a * cover;
}
