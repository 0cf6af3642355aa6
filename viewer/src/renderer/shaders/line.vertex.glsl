// Draws lines of the map on the ground. Each segment is a strip.
layout(location = 0) in vec4 ends; // both ends of a segment, in meters from the middle of the grid
uniform float ground, width;
uniform bool isPerspective;
out float off;

// Returns the pixel of a place on the ground, from the lower left, and a number that is above 0 if the place is before
// the camera.
vec3 toPixel(vec2 at) {
    vec3 p = vec3(at, ground) - eye;
    float depth = dot(p, forward);
    float s = isPerspective ? scale / depth : 1.0 / scale;
    return vec3(0.5 * size.x + dot(p, right) * s, 0.5 * size.y + dot(p, up) * s, isPerspective ? depth : 1.0);
}

void main() {
    // Move a segment that reaches behind the camera out of the picture, because its end has no pixel.
    vec3 a = toPixel(ends.xy), b = toPixel(ends.zw);
    if (a.z <= 0.0 || b.z <= 0.0) {
        gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
        return;
    }
    // Find the direction of the segment in the picture. A segment without length gets an arbitrary direction.
    vec2 way = b.xy - a.xy;
    vec2 unit = length(way) > 1e-4 ? normalize(way) : vec2(1.0, 0.0);
    // Place one of the strip's four corners. The strip is 0.7 pixels wider than the line on each
    // side, because edges fade there. It is 0.3 pixels longer at each end, so that segments
    // overlap.
    float side = float(gl_VertexID & 1) * 2.0 - 1.0;
    bool isEnd = (gl_VertexID & 2) == 2;
    float half_ = 0.5 * width + 0.7;
    vec2 at = (isEnd ? b.xy + 0.3 * unit : a.xy - 0.3 * unit) + side * half_ * vec2(-unit.y, unit.x);
    off = side * half_;
    gl_Position = vec4(2.0 * at / size - 1.0, 0.0, 1.0);
}
