// Draws veils of air that was not seen or is range folded, before the ground and behind all echo
// (render/volume/haze.h).
uniform sampler3D air; // in coarse cells, the share of air that was not seen, and of range folded air
uniform vec2 airFirst; // where the coarse cells begin, in cells of the grid
uniform vec2 airCells; // width of a coarse cell in cells of the grid, and its height in levels
uniform vec3 hazeColor, foldedColor;
const int steps = 192;
void main() {
    vec3 start = rayStart(), along = rayStep();
    vec2 depths = depthsInBox(start, along);
    float enter = depths.x, leave = depths.y;
    color = vec4(0.0);
    // Return before depths become step numbers, because they can be too large for an integer if a ray misses the grid.
    if (!(enter < leave)) return;
    // Divide the whole depth of the grid into steps that are the same for all rays, so that a veil has no edges.
    float whole = slices * stepM, each = whole / float(steps);
    vec2 way = vec2(0.0);
    int first = int(max(0.0, floor((enter - near) / each)));
    int last = int(min(float(steps), ceil((leave - near) / each)));
    vec3 size3 = vec3(textureSize(air, 0));
    // Add up the shares in the middles of these steps.
    for (int i = first; i < last; ++i) {
        float depth = near + (float(i) + 0.5) * each;
        if (depth < enter || depth > leave) continue;
        vec3 at = floor((cellOf(start + depth * along) + 0.5 - vec3(airFirst, 0.0)) / airCells.xxy);
        if (any(lessThan(at, vec3(0.0))) || any(greaterThanEqual(at, size3))) continue;
        way += texture(air, (at + 0.5) / size3).rg;
    }
    // Turn the lengths into opacities of at most 0.6. A length of a fifth of the grid's depth gives about 0.4.
    way = 0.6 * (1.0 - exp(-way * each * length(along) / (0.2 * whole)));
#ifdef HAS_HAZE
    color = vec4(hazeColor, 1.0) * way.x;
#endif
#ifdef HAS_FOLDED
    color = vec4(foldedColor, 1.0) * way.y + (1.0 - way.y) * color;
#endif
}
