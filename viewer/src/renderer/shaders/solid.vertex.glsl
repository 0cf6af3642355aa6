// Draws triangles of a field or of a cone in drawn space.
layout(location = 0) in vec3 corner; // x and y from the middle of the grid, height above sea level
layout(location = 1) in vec2 place; // place in the field (texels), or azimuth and slant range on the cone
uniform float exaggeration;
out vec2 at;
out float away; // depth
void main() {
    vec3 p = vec3(corner.xy, corner.z * exaggeration) - eye;
    away = dot(p, forward);
    at = place;
    vec2 aside = 2.0 * vec2(dot(p, right), dot(p, up)) / size;
#ifdef IS_PERSPECTIVE
    gl_Position = vec4(aside * scale, 0.0, away);
#else
    gl_Position = vec4(aside / scale, 0.0, 1.0);
#endif
}
