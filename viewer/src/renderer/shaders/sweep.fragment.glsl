// The gates of a sweep: each pixel shows one gate, of the nearest radial. `at` is azimuth and slant range. The sweep is
// drawn as far as it reaches, also beyond the grid.
uniform usampler2D codes; // gates along x, radials along y
uniform usampler2D radials; // by azimuth; of each radial the number of its gates
uniform vec2 gateLine; // gate = x + y * slant range
uniform vec2 valueLine; // value = x + y * code
uniform float firstValue;
void main() {
    // Look up the nearest radial by azimuth, which is kept in rows of the texture.
    int step_ = int(clamp(at.x * float(AZIMUTH_STEPS / 360), 0.0, float(AZIMUTH_STEPS - 1)));
    uvec2 radial = texelFetch(radials, ivec2(step_ % RADIALS_ACROSS, step_ / RADIALS_ACROSS), 0).rg;
    // Show nothing before the first gate and behind the last, and azimuths without a radial as not seen.
    int gate = int(floor(gateLine.x + gateLine.y * at.y));
    if (gate < 0 || (radial.x != NO_RADIAL && gate >= int(radial.y))) discard;
    if (radial.x == NO_RADIAL) {
        putAnywhere(solidColor(0, 0.0));
        return;
    }
    // Show the gate by its code: 1 is range folded, values begin at firstValue.
    float code = float(texelFetch(codes, ivec2(gate, int(radial.x)), 0).r);
    putAnywhere(solidColor(code >= firstValue ? 3 : code == 1.0 ? 2 : 1, valueLine.x + valueLine.y * code));
}
