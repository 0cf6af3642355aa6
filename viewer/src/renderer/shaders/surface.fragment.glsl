// Draws a surface. Inside of it, at least half of the cells about a place have values, and the mean of these values is
// at least the chosen value (with IS_BELOW, at most). Where a crop cuts the surface open, the cut shows the values
// inside.
uniform float chosen; // shown code of the surface's value
uniform vec2 depthRange;
uniform vec3 cellM; // size of a cell in drawn space

const float surfaceExposure = 0.86; // makes a surface about as light as its color
const vec3 plainColor = vec3(0.62); // color where the table has none
#ifdef IS_COLUMN
uniform vec3 columnColor;
const float thin = 0.55, thick = 0.95; // opacity where the ray meets the column at a right angle, and at its edge
#endif
const float nowhere = 1e30; // depth if the ray misses the surface; other depths may be less than 0

// Returns the mean code at a place, and the share of cells with values.
vec2 codeAt(vec3 p) {
    vec3 cell = cellOf(p);
    ivec3 brick = ivec3(cell / edge);
    uint entry = texelFetch(indirection, brick, 0).r;
    if (isEmpty(entry)) return vec2(0.0);
    vec2 found = fetchAt(cell, placeOf(brick, entry, slots), perTexel);
    return found.g < 0.002 ? vec2(0.0) : vec2(255.0 * found.r / found.g, found.g);
}

#ifdef IS_COLUMN
#elif defined(HAS_OTHER)
uniform sampler3D otherAtlas;
uniform usampler3D otherIndirection;
uniform vec3 otherSlots;
uniform vec3 otherPerTexel;
// Returns the code of the other moment, which colors the surface; less than 0 without a value.
float coloringCode(vec3 p) {
    vec3 cell = cellOf(p);
    ivec3 brick = ivec3(cell / edge);
    uint entry = texelFetch(otherIndirection, brick, 0).r;
    if (isEmpty(entry)) return -1.0;
    vec2 found = texture(otherAtlas, (cell + placeOf(brick, entry, otherSlots).xyz) * otherPerTexel).rg;
    return found.g < 0.1 ? -1.0 : 255.0 * found.r / found.g;
}
#else
float coloringCode(vec3 p) {
    return codeAt(p).x;
}
#endif

bool insideAt(vec3 p) {
    vec2 found = codeAt(p);
#ifdef IS_BELOW
    return found.y >= 0.5 && found.x <= chosen;
#else
    return found.y >= 0.5 && found.x >= chosen;
#endif
}

// Returns a measure that grows inward.
float levelAt(vec3 p) {
    vec2 found = codeAt(p);
#ifdef IS_BELOW
    return -found.x * found.y;
#else
    return found.x * found.y;
#endif
}

// Returns in which direction and how steeply the measure falls, by differences between the cells on both sides.
vec3 outwardAt(vec3 p) {
    vec3 x = vec3(cellM.x, 0.0, 0.0), y = vec3(0.0, cellM.y, 0.0), z = vec3(0.0, 0.0, cellM.z);
    vec3 fall = vec3(
        levelAt(p - x) - levelAt(p + x),
        levelAt(p - y) - levelAt(p + y),
        levelAt(p - z) - levelAt(p + z));
    return fall / cellM;
}

// Steps along a ray until it is inside of the surface. Returns the depth of the last step outside and of the first step
// inside; the latter is `nowhere` if the ray misses the surface.
vec2 stepsAcross(vec3 start, vec3 along, float enter, float leave) {
    float k = max(0.0, floor((enter - near) / stepM));
    float last = min(slices, ceil((leave - near) / stepM));
    Ray ray = rayOf(start, along);
    float outside = enter;
    for (int guard = 0; guard < 8192 && k < last; ++guard) {
        float depth = min(near + (k + 1.0) * stepM, leave);
        vec3 p = start + depth * along;
        // Skip the rest of a brick whose values are all outside.
        ivec3 brick = ivec3(cellOf(p) / edge);
        uint entry = texelFetch(indirection, brick, 0).r;
        if (isEmpty(entry) || (entry >> 24) < leastShown) {
            outside = depth;
            k = max(k + 1.0, floor((min(leaves(ray, brick, entry), leave) - near) / stepM));
            continue;
        }
        if (insideAt(p)) return vec2(outside, depth);
        outside = depth;
        k += 1.0;
    }
    return vec2(outside, nowhere);
}

void main() {
    vec3 start = rayStart(), along = rayStep();
    vec2 depths = depthsInBox(start, along);
    float enter = depths.x, leave = depths.y;
    if (!(enter < leave)) discard;
    // Find the step in which the ray gets inside. Where a crop cuts the surface open, the ray begins inside.
    bool isCut = insideAt(start + enter * along);
    vec2 found = isCut ? vec2(enter) : stepsAcross(start, along, enter, leave);
    float outside = found.x, hit = found.y;
    if (hit == nowhere) discard;
    // Halve that step ten times, so that slices do not show in the surface.
    if (!isCut) {
        for (int i = 0; i < 10; ++i) {
            float middle = 0.5 * (outside + hit);
            if (insideAt(start + middle * along)) hit = middle;
            else outside = middle;
        }
    }
    // Color the place by its value, or by the value of the other moment. Light it unless it is on a cut.
    vec3 p = start + hit * along;
#ifdef IS_COLUMN
    vec3 outward = normalize(outwardAt(p)), toward = normalize(along);
    float aside = 1.0 - abs(dot(outward, toward));
    color = vec4(litColor(columnColor, surfaceExposure * facing(outward, 1.0, toward)), 1.0) * mix(thin, thick, aside * aside);
#else
    float code = coloringCode(p);
    vec4 look = lookOf(code);
    vec3 rgb = code < 0.0 || look.a == 0.0 ? plainColor : look.rgb;
    float factor = isCut ? 1.0 : surfaceExposure * facing(outwardAt(p), 1.0, normalize(along));
    color = vec4(litColor(rgb, factor), 1.0);
    gl_FragDepth = clamp((hit - depthRange.x) / (depthRange.y - depthRange.x), 0.0, 0.999999);
#endif
}
