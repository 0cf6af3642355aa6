// The volume is drawn as points, each a square of the picture (echo_tiles.ts).
layout(location = 0) in vec4 tile; // its middle, and between which depths its rays may meet what shows
uniform float side; // in pixels
flat out vec2 reach;
void main() {
    reach = tile.zw;
    gl_Position = vec4(tile.xy, 0.0, 1.0);
    gl_PointSize = side;
}
