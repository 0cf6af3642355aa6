// Steps rays through the cells of a grid, whose bricks of 16 x 16 x 16 cells are scattered over a texture, the atlas.
//
// Without a graphics processor, each read of a uniform costs a check, and all branches of a condition are run. So the
// programs read uniforms before loops, and have few conditions.
uniform sampler3D atlas;
// An entry for each brick (atlas/atlas.ts). 21 bits have the slot + 1, or 0 without a slot; 3 bits have the halvings of
// the brick in the slot; 8 bits have the greatest shown code. Without a slot, the 3 bits have the distance in columns
// to the nearest column with a slot.
uniform usampler3D indirection;
uniform sampler2D transfer;
#ifdef HAS_UNEVEN_LEVELS
uniform sampler2D levels;
uniform vec2 levelRange; // least and greatest drawn height of the table `levels`
#else
uniform vec2 levelLine; // level = x + y * drawn height
#endif
uniform vec3 boxLow, boxHigh;
uniform float brickHeights[66]; // drawn heights at which layers of bricks begin, and at which the last layer ends
uniform vec3 cells;
uniform vec2 perCell; // cells in a meter, along x and y
uniform vec3 slots; // numbers of slots along x, along y, and in a layer
uniform vec3 perTexel; // 1 / number of texels of the atlas along each axis
uniform vec2 binLine; // bin = x + y * shown code
uniform uint leastShown; // bricks whose shown codes are all lower show nothing
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

// Returns a place in cells, which may be outside of the grid.
vec3 placeInCells(vec3 p) {
    return vec3(p.xy * perCell + 0.5 * (cells.xy - 1.0), levelOf(p.z));
}
vec3 cellOf(vec3 p) {
    return clamp(placeInCells(p), vec3(0.0), cells - 1.0);
}

// A ray in cells. The caller chooses the unit of its length.
struct Ray {
    vec3 start, along, perCell;
    vec3 ahead; // 1 for axes along which the ray rises, else 0
    vec3 last; // last cell of the grid
#ifdef HAS_UNEVEN_LEVELS
    vec2 height; // drawn height at the start, and its change per unit of length
#endif
};

Ray rayOf(vec3 start, vec3 along) {
    Ray ray;
    ray.start = placeInCells(start);
    // Keep drawn heights where levels are uneven, because the ray is not straight in levels.
#ifdef HAS_UNEVEN_LEVELS
    ray.along = vec3(along.xy * perCell, along.z);
    ray.height = vec2(start.z, along.z);
#else
    ray.along = vec3(along.xy * perCell, levelLine.y * along.z);
#endif
    ray.ahead = step(0.0, ray.along);
    // Replace 0 by a tiny number, so that a ray along an axis does not divide by 0.
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

// Returns the depths at which a ray enters and leaves the box, limited to the depths of the slices. If the ray misses
// the box, the first depth is not less than the second.
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

// Returns how to convert cells of a brick to texels: an offset, and the factor for columns and rows.
vec4 placeOf(ivec3 brick, uint entry, vec3 slots) {
    // Find the slot in the atlas. Half a slot is added, so that rounding cannot change the whole part of a quotient.
    float slot = float(int(entry & 0x1FFFFFu)) - 1.0;
    float z = floor((slot + 0.5) / slots.z);
    float y = floor((slot - z * slots.z + 0.5) / slots.x);
    vec4 place = vec4(vec3(slot - z * slots.z - y * slots.x, y, z) * padded + 1.5, 1.0);
#ifdef HAS_HALVED
    // Scale columns and rows of a halved grid. After n halvings, cell j covers 2^n cells from j 2^n on, whose middle is
    // at (j + 1/2) 2^n - 1/2.
    int halvings = int((entry >> 21) & 7u);
    place.w = exp2(-float(halvings));
    place.xy += 0.5 * place.w - 0.5;
    brick.xy >>= halvings;
#endif
    place.xyz -= vec3(brick) * edge;
    return place;
}

// Interpolates eight cells of the atlas. Returns the mean code times the share of cells with values, and this share.
vec2 fetchAt(vec3 cell, vec4 place, vec3 perTexel) {
    COUNT_FETCH
#ifdef HAS_HALVED
    cell.xy *= place.w;
#endif
    return texture(atlas, (cell + place.xyz) * perTexel).rg;
}

// Returns the length of the ray at which it leaves a brick. If the column of the brick is empty, the ray also leaves
// all empty columns about it.
float leaves(Ray ray, ivec3 brick, uint entry) {
    // Take the box of the brick, or of the empty columns about it, and the three sides by which the ray may leave it.
    float reach = isEmpty(entry) ? float(int(entry)) * (1.0 / 2097152.0) : 0.0;
    float beside = max(reach - 1.0, 0.0);
    vec3 bounds = (vec3(brick) + vec3(mix(vec2(-beside), vec2(beside + 1.0), ray.ahead.xy), ray.ahead.z)) * edge;
    // Follow the ray to each of these sides. It leaves through the nearest.
    vec3 far = (bounds - ray.start) * ray.perCell;
#ifdef HAS_UNEVEN_LEVELS
    far.z = (brickHeights[brick.z + int(ray.ahead.z)] - ray.height.x) * ray.perCell.z;
#endif
    return min(min(far.x, far.y), reach == 0.0 ? far.z : far.x);
}
