// Draws the gates of a sweep, also beyond the grid. Each pixel shows one gate of the nearest radial. `at` is azimuth
// and slant range.
uniform usampler2D codes; // gates along x, radials along y
uniform usampler2D radials; // number of the radial and its number of gates, by azimuth
uniform vec2 gateLine; // gate = x + y * slant range
uniform vec2 valueLine; // value = x + y * code
uniform float firstValue, ambiguous; // codes; `ambiguous` is less than 0 if no gate can be ambiguous
void main() {
    // Look up the nearest radial by azimuth. The azimuths fill rows of the texture.
    int step_ = int(clamp(at.x * float(AZIMUTH_STEPS / 360), 0.0, float(AZIMUTH_STEPS - 1)));
    uvec2 radial = texelFetch(radials, ivec2(step_ % RADIALS_ACROSS, step_ / RADIALS_ACROSS), 0).rg;
    // Draw nothing before the first gate and after the last. Azimuths without a radial are not seen.
    int gate = int(floor(gateLine.x + gateLine.y * at.y));
    if (gate < 0 || (radial.x != NO_RADIAL && gate >= int(radial.y))) discard;
    if (radial.x == NO_RADIAL) {
        putAnywhere(solidColor(0, 0.0));
        return;
    }
    // Draw the gate by its code: 1 is range folded, and values begin at firstValue (wire/packed_sweep.ts).
    float code = float(texelFetch(codes, ivec2(gate, int(radial.x)), 0).r);
    int state = code >= firstValue ? 3 : code == ambiguous ? 5 : code == 1.0 ? 2 : 1;
    putAnywhere(solidColor(state, valueLine.x + valueLine.y * code));
}
