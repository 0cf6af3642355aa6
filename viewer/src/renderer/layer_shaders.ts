// The shaders of what is drawn beside ground and volume. Each is compiled when a layer needs it first.

import { azimuthSteps, noRadial } from '../fields/sweep_cone';
import { lookColumns, lookCount } from '../tables/looks';
import { facingText, litColorText } from './light_shader';
import { VolumeVariant, camera, volumeHead } from './shaders';

// Places on a field or a cone as triangles in drawn space. `away` is the depth along the ray.
export const solidVertex = (isPerspective: boolean): string => `#version 300 es
layout(location = 0) in vec3 corner; // x and y from the middle of the grid, height above sea level
layout(location = 1) in vec2 place; // on what is shown
uniform vec2 size;
uniform vec3 eye, right, up, forward;
uniform float scale, exaggeration;
out vec2 at;
out vec3 drawn;
out float away;
void main() {
    drawn = vec3(corner.xy, corner.z * exaggeration);
    vec3 p = drawn - eye;
    away = dot(p, forward);
    at = place;
    vec2 aside = 2.0 * vec2(dot(p, right), dot(p, up)) / size;
    gl_Position = ${isPerspective ? 'vec4(aside * scale, 0.0, away)' : 'vec4(aside / scale, 0.0, 1.0)'};
}`;

// Colors by value, or by code of a value.
const looksText = `
uniform sampler2D looks;
uniform vec2 lookLine; // entry = x + y * value
vec4 lookOf(float value) {
    int entry = int(clamp(floor(lookLine.x + lookLine.y * value), 0.0, ${(lookCount - 1).toFixed(1)}));
    return texelFetch(looks, ivec2(entry % ${lookColumns}, entry / ${lookColumns}), 0);
}`;

const solidHead = (isPerspective: boolean): string => `#version 300 es
precision highp float;
precision highp int;
precision highp usampler2D;
${camera(isPerspective)}
${looksText}
uniform vec3 seenColor, foldedColor, hatchColor, borderColor;
uniform vec2 depthRange;
in vec2 at;
in vec3 drawn;
in float away;
out vec4 color;
// The color of a state and a value; clear air leaves the pixel to what is behind.
vec3 solidColor(int state, float value) {
    if (state == 2) return foldedColor;
    if (state == 0) {
        vec2 p = floor(pixel());
        if (mod(p.x + p.y, 9.0) >= 1.5) discard;
        return hatchColor;
    }
    if (state != 3) discard;
    vec4 look = lookOf(value);
    if (look.a == 0.0) discard;
    return mix(seenColor, look.rgb, look.a);
}
// Before the grid, and behind it, is as near and as far as the grid's edges.
void putAnywhere(vec3 rgb) {
    color = vec4(rgb, 1.0);
    gl_FragDepth = clamp((away - depthRange.x) / (depthRange.y - depthRange.x), 0.0, 0.999999);
}
void put(vec3 rgb) {
    if (away < depthRange.x) discard;
    putAnywhere(rgb);
}`;

// A field of values and states (fields/flat_field.ts): on a plane, or upright. States of four texels mix
// by the status rule; values mix only with values. State 4 lies beyond the grid.
export const fieldText = `
uniform sampler2D field; // value, state
uniform bool mixes;
vec2 fieldAt(vec2 place) {
    ivec2 most = textureSize(field, 0) - 1;
    vec2 nearest = texelFetch(field, clamp(ivec2(floor(place)), ivec2(0), most), 0).rg;
    if (!mixes || nearest.y > 3.5) return nearest;
    vec2 low = floor(place - 0.5), share = place - 0.5 - low;
    vec4 weights = vec4(0.0);
    float sum = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 side = ivec2(i & 1, i >> 1);
        vec2 one = texelFetch(field, clamp(ivec2(low) + side, ivec2(0), most), 0).rg;
        float weight = (side.x == 1 ? share.x : 1.0 - share.x) * (side.y == 1 ? share.y : 1.0 - share.y);
        if (one.y < 0.5) weights.x += weight;
        else if (one.y < 1.5) weights.y += weight;
        else if (one.y < 2.5) weights.z += weight;
        else if (one.y < 3.5) { weights.w += weight; sum += weight * one.x; }
    }
    if (weights.x > weights.y + weights.z + weights.w) return vec2(0.0, 0.0);
    if (weights.z > weights.w && weights.z > weights.y) return vec2(0.0, 2.0);
    if (weights.w < weights.y || weights.w == 0.0) return vec2(0.0, 1.0);
    return vec2(sum / weights.w, 3.0);
}`;

export const fieldFragment = (isPerspective: boolean): string => `${solidHead(isPerspective)}
${fieldText}
void main() {
    vec2 extent = vec2(textureSize(field, 0));
    vec2 border = min(at, extent - at) / fwidth(at);
    if (min(border.x, border.y) < 1.25) {
        put(borderColor);
        return;
    }
    vec2 found = fieldAt(at);
    if (found.y > 3.5) discard;
    put(solidColor(int(found.y + 0.5), found.x));
}`;

// The gates of a sweep: each pixel shows one gate, of the nearest radial. 'at' is azimuth and slant range. The sweep is
// drawn as far as it reaches, also beyond the grid.
export const sweepFragment = (isPerspective: boolean): string => `${solidHead(isPerspective)}
uniform usampler2D codes; // gates along x, radials along y
uniform usampler2D radials; // by azimuth; of each radial the number of its gates
uniform vec2 gateLine; // gate = x + y * slant range
uniform vec2 valueLine; // value = x + y * code
uniform float firstValue;
void main() {
    int step_ = int(clamp(at.x * ${(azimuthSteps / 360).toFixed(1)}, 0.0, ${(azimuthSteps - 1).toFixed(1)}));
    uvec2 radial = texelFetch(radials, ivec2(step_ % 1800, step_ / 1800), 0).rg;
    int gate = int(floor(gateLine.x + gateLine.y * at.y));
    if (gate < 0 || (radial.x != ${noRadial}u && gate >= int(radial.y))) discard;
    if (radial.x == ${noRadial}u) {
        putAnywhere(solidColor(0, 0.0));
        return;
    }
    float code = float(texelFetch(codes, ivec2(gate, int(radial.x)), 0).r);
    putAnywhere(solidColor(code >= firstValue ? 3 : code == 1.0 ? 2 : 1, valueLine.x + valueLine.y * code));
}`;

// The greatest values of the columns, on the ground.
export const drapeFragment = (isPerspective: boolean): string => `#version 300 es
precision highp float;
${camera(isPerspective)}
${looksText}
uniform vec3 seenColor, foldedColor;
uniform vec2 halfSize; // of the grid
uniform vec4 extent; // of the field: west, south, east, north
uniform float ground;
${fieldText}
out vec4 color;
void main() {
    vec3 start = rayStart(), along = rayStep();
    float depth = (ground - start.z) / along.z;
    if (along.z > -1e-6 || ${isPerspective ? 'depth <= 0.0' : 'false'}) discard;
    vec2 on = (start + depth * along).xy;
    vec2 place = (on - extent.xy) / (extent.zw - extent.xy);
    if (any(greaterThanEqual(abs(on), halfSize)) || any(lessThan(place, vec2(0.0))) || any(greaterThanEqual(place, vec2(1.0)))) discard;
    vec2 found = fieldAt(place * vec2(textureSize(field, 0)));
    int state = int(found.y + 0.5);
    if (state == 2) color = vec4(foldedColor, 1.0);
    else if (state == 3) {
        vec4 look = lookOf(found.x);
        if (look.a == 0.0) discard;
        color = vec4(mix(seenColor, look.rgb, look.a), 1.0);
    } else discard;
}`;

// Puts what is solid over the picture.
export const showSolidsFragment = `#version 300 es
precision highp float;
uniform sampler2D solidColor, solidDepth;
out vec4 color;
void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    if (texelFetch(solidDepth, at, 0).r == 1.0) discard;
    color = texelFetch(solidColor, at, 0);
}`;

export interface AirVariant {
    isPerspective: boolean;
    hasUnevenLevels: boolean;
    hasHaze: boolean; // of air that was not seen
    hasFolded: boolean;
}

export const airName = (variant: AirVariant): string =>
    [
        'air',
        variant.isPerspective ? 'perspective' : 'parallel',
        variant.hasUnevenLevels ? 'uneven levels' : '',
        variant.hasHaze ? 'not seen' : '',
        variant.hasFolded ? 'folded' : '',
    ]
        .filter((part) => part !== '')
        .join(', ');

// Veils before the ground, behind all echo (render/volume/haze.h).
export function airFragment(variant: AirVariant): string {
    return `${volumeHead(variant)}
uniform sampler3D air; // shares of not seen and of range folded
uniform vec2 airFirst; // where it begins, in cells of the grid
uniform vec2 airCells; // how many of these a coarse cell is wide and high
uniform vec3 hazeColor, foldedColor;
const int steps = 192;
void main() {
    vec3 start = rayStart(), along = rayStep();
    vec2 depths = depthsInBox(start, along);
    float enter = depths.x, leave = depths.y;
    color = vec4(0.0);
    // Beside the grid a ray along an axis has depths beyond all whole numbers.
    if (!(enter < leave)) return;
    float whole = slices * stepM, each = whole / float(steps);
    vec2 way = vec2(0.0);
    int first = int(max(0.0, floor((enter - near) / each)));
    int last = int(min(float(steps), ceil((leave - near) / each)));
    vec3 size3 = vec3(textureSize(air, 0));
    for (int i = first; i < last; ++i) {
        float depth = near + (float(i) + 0.5) * each;
        if (depth < enter || depth > leave) continue;
        vec3 at = floor((cellOf(start + depth * along) + 0.5 - vec3(airFirst, 0.0)) / airCells.xxy);
        if (any(lessThan(at, vec3(0.0))) || any(greaterThanEqual(at, size3))) continue;
        way += texture(air, (at + 0.5) / size3).rg;
    }
    way = 0.6 * (1.0 - exp(-way * each * length(along) / (0.2 * whole)));
${variant.hasHaze ? '    color = vec4(hazeColor, 1.0) * way.x;' : ''}
${variant.hasFolded ? '    color = vec4(foldedColor, 1.0) * way.y + (1.0 - way.y) * color;' : ''}
}`;
}

export interface SurfaceVariant extends VolumeVariant {
    isBelow: boolean; // it encloses what is at most the value
    hasOther: boolean; // another moment colors it
}

export const surfaceName = (variant: SurfaceVariant): string =>
    [
        'surface',
        variant.isPerspective ? 'perspective' : 'parallel',
        variant.hasUnevenLevels ? 'uneven levels' : '',
        variant.hasHalved ? 'halved bricks' : '',
        variant.isBelow ? 'below' : '',
        variant.hasOther ? 'colored by another' : '',
    ]
        .filter((part) => part !== '')
        .join(', ');

// By it the lightness of a surface is about that of its color.
const surfaceExposure = 0.86;

const otherText = `
uniform sampler3D otherAtlas;
uniform usampler3D otherIndirection;
uniform vec3 otherSlots;
uniform vec3 otherPerTexel;
// The code by which the surface is colored; less than 0 where there is none.
float otherCode(vec3 cell) {
    ivec3 brick = ivec3(cell / edge);
    uint entry = texelFetch(otherIndirection, brick, 0).r;
    if (isEmpty(entry)) return -1.0;
    vec2 found = texture(otherAtlas, (cell + placeOf(brick, entry, otherSlots).xyz) * otherPerTexel).rg;
    return found.g < 0.1 ? -1.0 : 255.0 * found.r / found.g;
}`;

// Encloses where at least half of the cells about have values, and their mean is at least the one that
// was chosen. Where a crop cuts it open, its inside shows the values there.
export function surfaceFragment(variant: SurfaceVariant): string {
    const isInside = variant.isBelow ? 'code <= chosen' : 'code >= chosen';
    return `${volumeHead(variant)}
uniform float chosen; // shown code
${looksText}
uniform vec2 depthRange;
uniform vec3 cellM; // of drawn space
${litColorText}
${facingText}
${variant.hasOther ? otherText : ''}
vec2 codeAt(vec3 p) {
    vec3 cell = cellOf(p);
    ivec3 brick = ivec3(cell / edge);
    uint entry = texelFetch(indirection, brick, 0).r;
    if (isEmpty(entry)) return vec2(0.0);
    vec2 found = fetchAt(cell, placeOf(brick, entry, slots), perTexel);
    return found.g < 0.002 ? vec2(0.0) : vec2(255.0 * found.r / found.g, found.g);
}
bool insideAt(vec3 p) {
    vec2 found = codeAt(p);
    float code = found.x;
    return found.y >= 0.5 && ${isInside};
}
// Grows inward.
float levelAt(vec3 p) {
    vec2 found = codeAt(p);
    return ${variant.isBelow ? '-found.x * found.y' : 'found.x * found.y'};
}
vec3 outwardAt(vec3 p) {
    vec3 x = vec3(cellM.x, 0.0, 0.0), y = vec3(0.0, cellM.y, 0.0), z = vec3(0.0, 0.0, cellM.z);
    return vec3(levelAt(p - x) - levelAt(p + x), levelAt(p - y) - levelAt(p + y), levelAt(p - z) - levelAt(p + z)) / cellM;
}
void main() {
    vec3 start = rayStart(), along = rayStep();
    vec2 depths = depthsInBox(start, along);
    float enter = depths.x, leave = depths.y;
    if (!(enter < leave)) discard;
    float k = max(0.0, floor((enter - near) / stepM));
    float last = min(slices, ceil((leave - near) / stepM));
    Ray ray = rayOf(start, along);
    float outside = enter, hit = -1.0;
    bool isCut = insideAt(start + enter * along);
    if (isCut) hit = enter;
    for (int guard = 0; guard < 8192; ++guard) {
        if (k >= last || hit >= 0.0) break;
        float depth = min(near + (k + 1.0) * stepM, leave);
        vec3 p = start + depth * along;
        ivec3 brick = ivec3(cellOf(p) / edge);
        uint entry = texelFetch(indirection, brick, 0).r;
        if (isEmpty(entry) || (entry >> 24) < leastShown) {
            outside = depth;
            k = max(k + 1.0, floor((min(leaves(ray, brick, entry), leave) - near) / stepM));
            continue;
        }
        if (insideAt(p)) hit = depth;
        else outside = depth;
        k += 1.0;
    }
    if (hit < 0.0) discard;
    if (!isCut) {
        for (int i = 0; i < 10; ++i) {
            float middle = 0.5 * (outside + hit);
            if (insideAt(start + middle * along)) hit = middle;
            else outside = middle;
        }
    }
    vec3 p = start + hit * along;
    float code = ${variant.hasOther ? 'otherCode(cellOf(p))' : 'codeAt(p).x'};
    vec4 look = lookOf(code);
    vec3 rgb = code < 0.0 || look.a == 0.0 ? vec3(0.62) : look.rgb;
    float factor = isCut ? 1.0 : ${surfaceExposure} * facing(outwardAt(p), 1.0, normalize(along));
    color = vec4(litColor(rgb, factor), 1.0);
    gl_FragDepth = clamp((hit - depthRange.x) / (depthRange.y - depthRange.x), 0.0, 0.999999);
}`;
}
