// Draws the tiles of the volume as points (echo_tiles.ts).
layout(location = 0) in vec4 tile; // middle, and least and greatest depth at which its rays may meet visible echo
uniform float side; // side of a tile, in pixels
flat out vec2 reach;
void main() {
    reach = tile.zw;
    gl_Position = vec4(tile.xy, 0.0, 1.0);
    gl_PointSize = side;
}
