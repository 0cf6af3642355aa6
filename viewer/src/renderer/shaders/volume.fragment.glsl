// Draws the volume in slices, as render/volume/slicer.h does. The values at two neighboring slices select an entry of
// the transfer function.
flat in vec2 reach; // least and greatest depth at which this tile may show something
#ifdef IS_LIT
uniform float exposure;
#endif

// Returns the bin of a sample, and its share of cells with values.
vec2 sampleOf(vec2 found, vec2 binLine) {
    found.y = found.y < 0.002 ? 0.0 : found.y;
    float bin = clamp(floor(binLine.x + binLine.y * (found.x / found.y)), 0.0, 255.0);
    return vec2(found.y > 0.0 ? bin : 0.0, found.y);
}

// Returns color and optical depth between two samples. A sample without a value takes the bin of the other sample.
vec4 lookBetween(vec2 front, vec2 back) {
    // Bin 0 is clear, so between two samples in it there is nothing to see.
    if (front.x + back.x <= 0.0) return vec4(0.0);
    COUNT_FETCH
    ivec2 bins = ivec2(int(back.y > 0.0 ? back.x : front.x), int(front.y > 0.0 ? front.x : back.x));
    return texelFetch(transfer, bins, 0);
}

// Returns the pixel for the light that a ray has gathered, or for its count of fetches. `lit` is the sum of the light's
// factors, weighted like `light`.
vec4 shown(vec3 light, float through, float lit) {
    float alpha = 1.0 - through;
#if defined(COUNTS_FETCHES)
    return vec4(float(fetches & 255), float(fetches >> 8), 0.0, 255.0) / 255.0;
#elif defined(MEASURES_LIGHT)
    if (alpha < 1.0 / 512.0) return vec4(0.0);
    return vec4(lightnessOf(min(light / alpha, 1.0)), 0.5 * lit / alpha, alpha, 1.0);
#else
#ifdef IS_LIT
    if (alpha >= 1.0 / 512.0) light = alpha * litColor(min(light / alpha, 1.0), exposure * lit / alpha);
#endif
    return vec4(light, alpha);
#endif
}

// Returns the depths at which a ray enters the box, and at which it leaves the box or meets a solid layer.
vec2 depthsInSight(vec3 start, vec3 along) {
    vec2 depths = depthsInBox(start, along);
#ifdef ENDS_AT_SOLIDS
    depths.y = min(depths.y, solidAt());
#endif
    return depths;
}

void main() {
    color = vec4(0.0);
    vec3 start = rayStart(), along = rayStep();
    vec2 depths = depthsInSight(start, along);
    float enter = depths.x, leave = depths.y;
    if (!(enter < leave)) discard;
    // Count depths in slices from here on, and read the uniforms for the loop.
    float first = (enter - near) / stepM, end = (leave - near) / stepM;
    float last = min(slices, ceil(min(end, (reach.y - near) / stepM)));
    Ray ray = rayOf(start + near * along, stepM * along);
    float depthOfHalf = 0.5 * depthScale * length(along);
    vec3 slotsHere = slots, perTexelHere = perTexel;
    vec2 binLineHere = vec2(binLine.x, 255.0 * binLine.y);
    uint leastEntry = leastShown << 24;
    vec3 light = vec3(0.0);
    float through = 1.0, lit = 0.0;
#ifdef IS_LIT
    float frontLight = -1.0;
    vec3 looks = normalize(along);
#endif
    vec2 front = vec2(0.0); // bin, and share of cells with values
    ivec3 held = ivec3(-1); // brick of `entry`
    uint entry = 0u;
    // Begin one step before the ray enters the box. This step ends where the ray enters, and shows nothing.
    for (float k = max(0.0, floor(max(first, (reach.x - near) / stepM))) - 1.0; k < last && through >= enough;) {
        // Read the entry of the brick at the far end of the step, unless the ray is still in the same brick.
        vec3 cell = cellAt(ray, clamp(k + 1.0, first, end));
        ivec3 brick = ivec3(cell * (1.0 / edge));
        for (; brick != held; held = brick) {
            COUNT_FETCH
            entry = texelFetch(indirection, brick, 0).r;
        }
        // Sample the far end of the step, and look up its color. The near end is the far end of the step before.
        bool isClear = entry < leastEntry;
        vec2 found = vec2(0.0);
        if (!isClear) found = fetchAt(cell, placeOf(brick, entry, slotsHere), perTexelHere);
        vec2 back = sampleOf(found, binLineHere);
        vec4 look = lookBetween(front, back);
        // Composite the step behind all earlier steps. Its optical depth is scaled by the part of the step in the box,
        // and by the mean share of cells with values at both ends, so that echo tapers off.
        float inside = max(0.0, min(k + 1.0, end) - max(k, first));
        float seen = through * (1.0 - exp(-look.a * depthOfHalf * (front.y + back.y) * inside));
        light += seen * look.rgb;
        through -= seen;
#ifdef IS_LIT
        // Light the step. Two steps share one computation of the light, but a step that shows much has its own.
        if (seen > 0.0) {
            bool isOwn = frontLight < 0.0 || seen > 0.02;
            float at = clamp(isOwn ? k + 0.5 : k + 1.0, first, end);
            if (isOwn || mod(k, 2.0) < 0.5) frontLight = lightAt(cellAt(ray, at), looks);
            lit += seen * frontLight;
        } else frontLight = -1.0;
#endif
        front = back;
        // Skip the rest of a brick without visible values, and continue with the last slice in it.
        k = isClear ? max(k + 1.0, floor(leaves(ray, brick, entry))) : k + 1.0;
    }
    color = shown(light, through, lit);
}
