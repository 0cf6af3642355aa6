// Steps rays through the cells of a grid, whose bricks of 16 x 16 x 16 cells are scattered over a texture, the atlas.
//
// A processor that runs a program checks each reading of a uniform, and goes through all sides of a condition. So
// the programs read what loops need before them, and have few conditions.
uniform sampler3D atlas;
// An entry for each brick: 21 bits with its slot + 1, or 0 if it has none; three bits with the halvings of its grid;
// eight bits with the greatest shown code. Without a slot, the three bits say how many columns away the nearest brick
// with one is (atlas/atlas.ts).
uniform usampler3D indirection;
uniform sampler2D transfer;
#ifdef HAS_UNEVEN_LEVELS
uniform sampler2D levels;
uniform vec2 levelRange; // of drawn heights
#else
uniform vec2 levelLine; // level = x + y * drawn height
#endif
uniform vec3 boxLow, boxHigh;
uniform float brickHeights[66]; // drawn, of the lower ends of layers of bricks and of the last one's upper end
uniform vec3 cells;
uniform vec2 perCell; // cells a meter
uniform vec3 slots; // along x, along y, and both multiplied
uniform vec3 perTexel; // of the atlas
uniform vec2 binLine; // bin = x + y * shown code
uniform uint leastShown; // shown code
uniform float near, stepM, slices, depthScale;
out vec4 color;

const float edge = 16.0, padded = 18.0, enough = 0.001;

#ifdef COUNTS_FETCHES
int fetches = 0;
#define COUNT_FETCH ++fetches;
#else
#define COUNT_FETCH
#endif

// Returns the level at a drawn height, with a fraction.
float levelOf(float height) {
#ifdef HAS_UNEVEN_LEVELS
    COUNT_FETCH
    float place = (height - levelRange.x) / (levelRange.y - levelRange.x);
    return texture(levels, vec2(place, 0.5)).r;
#else
    return levelLine.x + levelLine.y * height;
#endif
}

// Returns a place in cells, which may lie outside of the grid.
vec3 placeInCells(vec3 p) {
    return vec3(p.xy * perCell + 0.5 * (cells.xy - 1.0), levelOf(p.z));
}
vec3 cellOf(vec3 p) {
    return clamp(placeInCells(p), vec3(0.0), cells - 1.0);
}

// A ray in cells. The unit in which it counts how far it went is the caller's.
struct Ray {
    vec3 start, along, perCell;
    vec3 ahead; // 1 along the axes on which it rises
    vec3 last; // cell
#ifdef HAS_UNEVEN_LEVELS
    vec2 height; // drawn: at the start, and by how much it rises
#endif
};

Ray rayOf(vec3 start, vec3 along) {
    Ray ray;
    ray.start = placeInCells(start);
    // Keep drawn heights where levels are uneven, because the ray is no straight line in levels.
#ifdef HAS_UNEVEN_LEVELS
    ray.along = vec3(along.xy * perCell, along.z);
    ray.height = vec2(start.z, along.z);
#else
    ray.along = vec3(along.xy * perCell, levelLine.y * along.z);
#endif
    ray.ahead = step(0.0, ray.along);
    // Take a tiny number for zero, so that a ray along an axis divides by none.
    ray.perCell = 1.0 / mix(vec3(1e-20), ray.along, step(1e-20, abs(ray.along)));
    ray.last = cells - 1.0;
    return ray;
}

vec3 cellAt(Ray ray, float far) {
    vec3 place = ray.start + far * ray.along;
#ifdef HAS_UNEVEN_LEVELS
    place.z = levelOf(ray.height.x + far * ray.height.y);
#endif
    return clamp(place, vec3(0.0), ray.last);
}

// Returns the depths between which a ray is in the box, as far as the slices go; the first is not the smaller one
// of a ray that misses it.
vec2 depthsInBox(vec3 start, vec3 along) {
    vec3 safe = mix(vec3(1e-12), along, step(1e-12, abs(along)));
    vec3 a = (boxLow - start) / safe, b = (boxHigh - start) / safe;
    vec3 lows = min(a, b), highs = max(a, b);
    float enter = max(max(lows.x, lows.y), max(lows.z, near));
    float leave = min(min(highs.x, highs.y), min(highs.z, near + slices * stepM));
    return vec2(enter, leave);
}

bool isEmpty(uint entry) {
    return (entry & 0x1FFFFFu) == 0u;
}

// Returns the way from cells to texels in a brick: an offset, and the factor of columns and rows.
vec4 placeOf(ivec3 brick, uint entry, vec3 slots) {
    // Find the slot in the atlas. With half a slot added, no quotient is so near to a whole number that rounding
    // matters.
    float slot = float(int(entry & 0x1FFFFFu)) - 1.0;
    float z = floor((slot + 0.5) / slots.z);
    float y = floor((slot - z * slots.z + 0.5) / slots.x);
    vec4 place = vec4(vec3(slot - z * slots.z - y * slots.x, y, z) * padded + 1.5, 1.0);
#ifdef HAS_HALVED
    // Shrink columns and rows of a halved grid: cell j of a grid that was halved n times stands for the cells from
    // j 2^n on, whose middle is at (j + 1/2) 2^n - 1/2.
    int halvings = int((entry >> 21) & 7u);
    place.w = exp2(-float(halvings));
    place.xy += 0.5 * place.w - 0.5;
    brick.xy >>= halvings;
#endif
    place.xyz -= vec3(brick) * edge;
    return place;
}

// Returns the mean of eight cells of the atlas: code times share, and share.
vec2 fetchAt(vec3 cell, vec4 place, vec3 perTexel) {
    COUNT_FETCH
#ifdef HAS_HALVED
    cell.xy *= place.w;
#endif
    return texture(atlas, (cell + place.xyz) * perTexel).rg;
}

// Returns how far the ray has gone when it leaves a brick. From a column of bricks without anything to show it
// leaves at once all columns about it that are as empty.
float leaves(Ray ray, ivec3 brick, uint entry) {
    // Take the box of the brick, or of as many columns as the entry says, and its sides that the ray leaves by.
    float reach = isEmpty(entry) ? float(int(entry)) * (1.0 / 2097152.0) : 0.0;
    float beside = max(reach - 1.0, 0.0);
    vec3 bounds = (vec3(brick) + vec3(mix(vec2(-beside), vec2(beside + 1.0), ray.ahead.xy), ray.ahead.z)) * edge;
    // Follow the ray to each of these sides; the nearest is where it leaves.
    vec3 far = (bounds - ray.start) * ray.perCell;
#ifdef HAS_UNEVEN_LEVELS
    far.z = (brickHeights[brick.z + int(ray.ahead.z)] - ray.height.x) * ray.perCell.z;
#endif
    return min(min(far.x, far.y), reach == 0.0 ? far.z : far.x);
}
