// Draws the solid layers over the picture.
uniform sampler2D solidColor, solidDepth;
out vec4 color;
void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    if (texelFetch(solidDepth, at, 0).r == 1.0) discard;
    color = texelFetch(solidColor, at, 0);
}
