// Reads the depth of the nearest solid layer in this pixel, where the ray ends; 1e30 if there is none.
uniform sampler2D solidDepth; // as a share of depthRange
uniform vec2 depthRange;
float solidAt() {
    float share = texelFetch(solidDepth, ivec2(pixel().x, size.y - pixel().y), 0).r;
    return share < 1.0 ? mix(depthRange.x, depthRange.y, share) : 1e30;
}
