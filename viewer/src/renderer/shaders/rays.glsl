// Computes the ray of a pixel in drawn space. Pixels count from the top left.

vec2 pixel() {
    return vec2(gl_FragCoord.x, size.y - gl_FragCoord.y);
}

// Returns the offset of the pixel from the middle of the picture, to the right and upward.
vec2 aside() {
    vec2 p = pixel();
    return vec2(p.x - 0.5 * size.x, 0.5 * size.y - p.y);
}

// A ray is rayStart() + depth * rayStep(). The component of rayStep() along `forward` is 1, so depths are along the
// direction of the view, not along the ray.
#ifdef IS_PERSPECTIVE
vec3 rayStart() {
    return eye;
}
vec3 rayStep() {
    vec2 a = aside() / scale;
    return forward + a.x * right + a.y * up;
}
#else
vec3 rayStart() {
    vec2 a = aside() * scale;
    return eye + a.x * right + a.y * up;
}
vec3 rayStep() {
    return forward;
}
#endif

// Returns true if a ray looks at or above the horizon, so that it does not meet the ground at this depth.
bool missesGround(vec3 along, float depth) {
#ifdef IS_PERSPECTIVE
    return along.z > -1e-6 || depth <= 0.0;
#else
    return along.z > -1e-6;
#endif
}
