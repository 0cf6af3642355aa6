// The shaders. A variant is compiled for what a scene calls for; what it does not use is not in it.

import { facingText, lightAtText, litColorText } from './light_shader';

export interface VolumeVariant {
    isPerspective: boolean;
    hasUnevenLevels: boolean;
    hasHalved?: boolean; // some bricks are those of halved grids
    countsFetches?: boolean; // the picture is how many texels each pixel asked for
    endsAtSolids?: boolean; // rays end at what is solid
    isLit?: boolean;
    measuresLight?: boolean; // the picture is lightness, factor of the light, and opacity
}

export function variantName(variant: VolumeVariant): string {
    const parts = [variant.isPerspective ? 'perspective' : 'parallel'];
    if (variant.hasUnevenLevels) parts.push('uneven levels');
    if (variant.hasHalved) parts.push('halved bricks');
    if (variant.countsFetches) parts.push('fetches counted');
    if (variant.endsAtSolids) parts.push('ends at solids');
    if (variant.isLit) parts.push('lit');
    if (variant.measuresLight) parts.push('light measured');
    return parts.join(', ');
}

export const fullScreenVertex = `#version 300 es
void main() {
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
    gl_Position = vec4(4.0 * corner - 1.0, 0.0, 1.0);
}`;

// Rays of the pixels, in drawn space; pixels count from the top left.
export const camera = (isPerspective: boolean) => `
uniform vec2 size;
uniform vec3 eye, right, up, forward;
uniform float scale; // focal length in pixels, or meters a pixel
vec2 pixel() { return vec2(gl_FragCoord.x, size.y - gl_FragCoord.y); }
vec2 aside() { vec2 p = pixel(); return vec2(p.x - 0.5 * size.x, 0.5 * size.y - p.y); }
${
    isPerspective
        ? `vec3 rayStart() { return eye; }
vec3 rayStep() { vec2 a = aside() / scale; return forward + a.x * right + a.y * up; }`
        : `vec3 rayStart() { vec2 a = aside() * scale; return eye + a.x * right + a.y * up; }
vec3 rayStep() { return forward; }`
}`;

// The volume is drawn as points, each a square of the picture (echo_tiles.ts).
export const tileVertex = `#version 300 es
layout(location = 0) in vec4 tile; // its middle, and between which depths its rays may meet what shows
uniform float side; // in pixels
flat out vec2 reach;
void main() {
    reach = tile.zw;
    gl_Position = vec4(tile.xy, 0.0, 1.0);
    gl_PointSize = side;
}`;

// Cell j of a grid that was halved n times stands for the cells from j 2^n on, whose middle is at
// (j + 1/2) 2^n - 1/2.
const halvedPlace = `
    int halvings = int((entry >> 21) & 7u);
    place.w = exp2(-float(halvings));
    place.xy += 0.5 * place.w - 0.5;
    brick.xy >>= halvings;`;

// Head of the programs in which rays meet the cells of a grid.
//
// A processor that runs a program checks each reading of a uniform, and goes through all sides of a
// condition. So the programs read what loops need before them, and have few conditions.
export function volumeHead(
    variant: Pick<VolumeVariant, 'isPerspective' | 'hasUnevenLevels' | 'hasHalved' | 'countsFetches'>,
): string {
    const counted = variant.countsFetches ? ' ++fetches;' : '';
    const { hasUnevenLevels } = variant;
    return `#version 300 es
precision highp float;
precision highp int;
precision highp sampler3D;
precision highp usampler3D;
uniform sampler3D atlas;
uniform usampler3D indirection;
uniform sampler2D transfer;
${hasUnevenLevels ? 'uniform sampler2D levels;\nuniform vec2 levelRange; // of drawn heights' : 'uniform vec2 levelLine; // level = x + y * drawn height'}
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
${camera(variant.isPerspective)}
const float edge = 16.0, padded = 18.0, enough = 0.001;
${variant.countsFetches ? 'int fetches = 0;' : ''}

float levelOf(float height) {${hasUnevenLevels ? counted : ''}
${
    hasUnevenLevels
        ? `    float place = (height - levelRange.x) / (levelRange.y - levelRange.x);
    return texture(levels, vec2(place, 0.5)).r;`
        : '    return levelLine.x + levelLine.y * height;'
}
}
// Not yet within the grid.
vec3 placeInCells(vec3 p) { return vec3(p.xy * perCell + 0.5 * (cells.xy - 1.0), levelOf(p.z)); }
vec3 cellOf(vec3 p) { return clamp(placeInCells(p), vec3(0.0), cells - 1.0); }

// A ray in cells. How far it went counts in any unit.
struct Ray {
    vec3 start, along, perCell;
    vec3 ahead; // 1 along the axes on which it rises
    vec3 last; // cell
${hasUnevenLevels ? '    vec2 height; // drawn: at the start, and by how much it rises' : ''}
};
Ray rayOf(vec3 start, vec3 along) {
    Ray ray;
    ray.start = placeInCells(start);
    ray.along = vec3(along.xy * perCell, ${hasUnevenLevels ? 'along.z' : 'levelLine.y * along.z'});
    ray.ahead = step(0.0, ray.along);
    ray.perCell = 1.0 / mix(vec3(1e-20), ray.along, step(1e-20, abs(ray.along)));
    ray.last = cells - 1.0;
${hasUnevenLevels ? '    ray.height = vec2(start.z, along.z);' : ''}
    return ray;
}
vec3 cellAt(Ray ray, float far) {
    vec3 place = ray.start + far * ray.along;
${hasUnevenLevels ? '    place.z = levelOf(ray.height.x + far * ray.height.y);' : ''}
    return clamp(place, vec3(0.0), ray.last);
}
// The depths between which a ray is in the box, as far as the slices go; the first is not the smaller one
// of a ray that misses it.
vec2 depthsInBox(vec3 start, vec3 along) {
    vec3 safe = mix(vec3(1e-12), along, step(1e-12, abs(along)));
    vec3 a = (boxLow - start) / safe, b = (boxHigh - start) / safe;
    vec3 lows = min(a, b), highs = max(a, b);
    return vec2(max(max(lows.x, lows.y), max(lows.z, near)), min(min(highs.x, highs.y), min(highs.z, near + slices * stepM)));
}
bool isEmpty(uint entry) { return (entry & 0x1FFFFFu) == 0u; }
// Returns the way from cells to texels in a brick: an offset, and the factor of columns and rows. With half a
// slot added, no quotient is so near to a whole number that rounding matters.
vec4 placeOf(ivec3 brick, uint entry, vec3 slots) {
    float slot = float(int(entry & 0x1FFFFFu)) - 1.0;
    float z = floor((slot + 0.5) / slots.z);
    float y = floor((slot - z * slots.z + 0.5) / slots.x);
    vec4 place = vec4(vec3(slot - z * slots.z - y * slots.x, y, z) * padded + 1.5, 1.0);${variant.hasHalved ? halvedPlace : ''}
    place.xyz -= vec3(brick) * edge;
    return place;
}
// Eight cells of the atlas: code times share, and share.
vec2 fetchAt(vec3 cell, vec4 place, vec3 perTexel) {${counted}
    return texture(atlas, (${variant.hasHalved ? 'vec3(cell.xy * place.w, cell.z)' : 'cell'} + place.xyz) * perTexel).rg;
}
// Returns how far the ray has gone when it leaves a brick. From a column of bricks without anything to show
// it leaves at once all columns about it that are as empty.
float leaves(Ray ray, ivec3 brick, uint entry) {
    float reach = isEmpty(entry) ? float(int(entry)) * (1.0 / 2097152.0) : 0.0;
    float beside = max(reach - 1.0, 0.0);
    vec3 bounds = (vec3(brick) + vec3(mix(vec2(-beside), vec2(beside + 1.0), ray.ahead.xy), ray.ahead.z)) * edge;
    vec3 far = (bounds - ray.start) * ray.perCell;
${hasUnevenLevels ? '    far.z = (brickHeights[brick.z + int(ray.ahead.z)] - ray.height.x) * ray.perCell.z;' : ''}
    return min(min(far.x, far.y), reach == 0.0 ? far.z : far.x);
}`;
}

const solidsText = `
uniform sampler2D solidDepth; // as a share of depthRange
uniform vec2 depthRange;
float solidAt() {
    float share = texelFetch(solidDepth, ivec2(pixel().x, size.y - pixel().y), 0).r;
    return share < 1.0 ? mix(depthRange.x, depthRange.y, share) : 1e30;
}`;

const litText = `
uniform float exposure;
${litColorText}
${facingText}
${lightAtText}`;

// Two steps share the light between them, but a step that shows much has its own.
const stepLit = `
        if (seen > 0.0) {
            bool isOwn = frontLight < 0.0 || seen > 0.02;
            if (isOwn || mod(k, 2.0) < 0.5) frontLight = lightAt(cellAt(ray, clamp(isOwn ? k + 0.5 : k + 1.0, first, end)), looks);
            lit += seen * frontLight;
        } else frontLight = -1.0;`;

// Lights what the ray has gathered.
const putLit = `
    float alpha = 1.0 - through;
    if (alpha >= 1.0 / 512.0) light = alpha * litColor(min(light / alpha, 1.0), exposure * lit / alpha);
    color = vec4(light, alpha);`;
const putMeasured = `
    float alpha = 1.0 - through;
    color = alpha < 1.0 / 512.0 ? vec4(0.0) : vec4(lightnessOf(min(light / alpha, 1.0)), 0.5 * lit / alpha, alpha, 1.0);`;
const putFetches = `
    color = vec4(float(fetches & 255), float(fetches >> 8), 0.0, 255.0) / 255.0;`;

// Slices as render/volume/slicer.h has them. A brick without visible values is left at once: the next
// slice that is looked at is the last one in it.
export function volumeFragment(variant: VolumeVariant): string {
    const { isLit, endsAtSolids } = variant;
    const counted = variant.countsFetches ? ' ++fetches;' : '';
    return `${volumeHead(variant)}
${endsAtSolids ? solidsText : ''}
${isLit ? litText : ''}
flat in vec2 reach;
void main() {
    color = vec4(0.0);
    vec3 start = rayStart(), along = rayStep();
    vec2 depths = depthsInBox(start, along);
    float enter = depths.x, leave = depths.y;
${endsAtSolids ? '    leave = min(leave, solidAt());' : ''}
    if (!(enter < leave)) discard;
    // From here on the ray goes from slice to slice.
    float first = (enter - near) / stepM, end = (leave - near) / stepM;
    float last = min(slices, ceil(min(end, (reach.y - near) / stepM)));
    Ray ray = rayOf(start + near * along, stepM * along);
    float depthOfHalf = 0.5 * depthScale * length(along);
    vec3 slotsHere = slots, perTexelHere = perTexel;
    vec2 binLineHere = vec2(binLine.x, 255.0 * binLine.y);
    uint leastEntry = leastShown << 24;
    vec3 light = vec3(0.0);
    float through = 1.0;
    vec2 front = vec2(0.0); // bin, and share of cells with values
    ivec3 held = ivec3(-1); // the brick whose entry the ray has
    uint entry = 0u;
${isLit ? '    float lit = 0.0, frontLight = -1.0;\n    vec3 looks = normalize(along);' : ''}
    // The first step ends where the ray enters: it shows nothing.
    for (float k = max(0.0, floor(max(first, (reach.x - near) / stepM))) - 1.0; k < last && through >= enough;) {
        vec3 cell = cellAt(ray, clamp(k + 1.0, first, end));
        ivec3 brick = ivec3(cell * (1.0 / edge));
        for (; brick != held; held = brick) {
            entry = texelFetch(indirection, brick, 0).r;${counted}
        }
        bool isClear = entry < leastEntry;
        vec2 found = vec2(0.0);
        if (!isClear) found = fetchAt(cell, placeOf(brick, entry, slotsHere), perTexelHere);
        found.y = found.y < 0.002 ? 0.0 : found.y;
        vec2 back = vec2(found.y > 0.0 ? clamp(floor(binLineHere.x + binLineHere.y * (found.x / found.y)), 0.0, 255.0) : 0.0, found.y);
        vec4 look = vec4(0.0);
        // Bin 0 is clear: between two ends in it there is nothing to see.
        if (front.x + back.x > 0.0) {
            look = texelFetch(transfer, ivec2(int(back.y > 0.0 ? back.x : front.x), int(front.y > 0.0 ? front.x : back.x)), 0);${counted}
        }
        float inside = max(0.0, min(k + 1.0, end) - max(k, first));
        float seen = through * (1.0 - exp(-look.a * depthOfHalf * (front.y + back.y) * inside));
        light += seen * look.rgb;
        through -= seen;
${isLit ? stepLit : ''}
        front = back;
        k = isClear ? max(k + 1.0, floor(leaves(ray, brick, entry))) : k + 1.0;
    }
${variant.countsFetches ? putFetches : variant.measuresLight ? putMeasured : isLit ? putLit : '    color = vec4(light, 1.0 - through);'}
}`;
}

// The ground as it was seen: light from low down, darker from high up only, hatched where it was not seen;
// land and water each in their own shades.
export function groundFragment(isPerspective: boolean): string {
    return `#version 300 es
precision highp float;
precision highp usampler2D;
uniform usampler2D coverage;
uniform vec2 columns; // of the grid
uniform float columnsATexel; // along each side
uniform vec2 halfSize; // of the grid, in meters
uniform float ground; // drawn height
uniform vec3 page, hatch;
uniform vec3 landShades[4], waterShades[4]; // not seen, seen from high up only, seen from low down, beyond the grid
uniform sampler2D water; // its share
uniform vec2 waterHalf; // how far that reaches from the middle
uniform float hatchScale;
out vec4 color;
${camera(isPerspective)}
void main() {
    vec3 start = rayStart(), along = rayStep();
    float depth = (ground - start.z) / along.z;
    if (along.z > -1e-6 || ${isPerspective ? 'depth <= 0.0' : 'false'}) {
        color = vec4(page, 1.0);
        return;
    }
    vec2 at = (start + depth * along).xy;
    vec2 place = (at + halfSize) / (2.0 * halfSize);
    // A shore is as sharp as a pixel, however near it is.
    float share = texture(water, 0.5 + vec2(0.5, -0.5) * at / waterHalf).r - 0.5;
    float isWater = clamp(0.5 + share / max(fwidth(share), 1e-3), 0.0, 1.0);
    if (any(lessThan(place, vec2(0.0))) || any(greaterThanEqual(place, vec2(1.0)))) {
        float away = length(max(abs(at) - halfSize, 0.0)) / max(halfSize.x, halfSize.y);
        color = vec4(mix(mix(landShades[3], waterShades[3], isWater), page, clamp(away / 1.5, 0.0, 1.0)), 1.0);
        return;
    }
    uint state = texelFetch(coverage, ivec2(place * columns / columnsATexel), 0).r;
    vec3 shade = mix(landShades[state], waterShades[state], isWater);
    if (state == 0u) {
        vec2 p = floor(pixel());
        float period = 9.0 * hatchScale;
        float phase = mod(p.x + p.y, period);
        float distance = min(phase, period - phase) / 1.41421356;
        shade = mix(shade, hatch, clamp(0.5 * hatchScale + 0.5 - distance, 0.0, 1.0));
    }
    color = vec4(shade, 1.0);
}`;
}

// Lines of the map on the ground, each segment a strip as wide as its kind.
export const lineVertex = `#version 300 es
layout(location = 0) in vec4 ends; // of a segment, meters from the middle
uniform vec2 size;
uniform vec3 eye, right, up, forward;
uniform float scale, ground, width;
uniform bool isPerspective;
out float off;
vec3 toPixel(vec2 at) {
    vec3 p = vec3(at, ground) - eye;
    float depth = dot(p, forward);
    float s = isPerspective ? scale / depth : 1.0 / scale;
    return vec3(0.5 * size.x + dot(p, right) * s, 0.5 * size.y + dot(p, up) * s, isPerspective ? depth : 1.0);
}
void main() {
    vec3 a = toPixel(ends.xy), b = toPixel(ends.zw);
    if (a.z <= 0.0 || b.z <= 0.0) { gl_Position = vec4(2.0, 2.0, 2.0, 1.0); return; }
    vec2 way = b.xy - a.xy;
    vec2 unit = length(way) > 1e-4 ? normalize(way) : vec2(1.0, 0.0);
    float side = float(gl_VertexID & 1) * 2.0 - 1.0;
    bool isEnd = (gl_VertexID & 2) == 2;
    float half_ = 0.5 * width + 0.7;
    vec2 at = (isEnd ? b.xy + 0.3 * unit : a.xy - 0.3 * unit) + side * half_ * vec2(-unit.y, unit.x);
    off = side * half_;
    gl_Position = vec4(2.0 * at / size - 1.0, 0.0, 1.0);
}`;
export const lineFragment = `#version 300 es
precision highp float;
uniform vec4 look;
uniform float width;
in float off;
out vec4 color;
void main() {
    float cover = clamp(0.5 * width + 0.5 - abs(off), 0.0, 1.0);
    color = vec4(look.rgb, 1.0) * look.a * cover;
}`;
