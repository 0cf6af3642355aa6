#include "synth/vcp.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace stormcellar::synth {
namespace {

constexpr double elevation_step_deg = 180.0 / 32768;
constexpr double rate_step_deg_s = 22.5 / 16384;

// The facts of each PRF, by its number, from the radial blocks of real volumes of one radar.
struct PrfFacts {
    float unambiguous_range_m;
    float nyquist_mps;
};
constexpr std::array<PrfFacts, 9> prf_facts = {{{0, 0},
                                                {467000, 8.32F},
                                                {430000, 9.04F},
                                                {336000, 12.30F},
                                                {162000, 23.96F},
                                                {148000, 26.24F},
                                                {137000, 28.34F},
                                                {127000, 30.60F},
                                                {117000, 33.21F}}};

constexpr auto surveillance = Waveform::surveillance;
constexpr auto doppler = Waveform::doppler;
constexpr auto batch = Waveform::batch;
constexpr auto high = Waveform::doppler_without_ambiguity;

// One line of a pattern as in message 5. The rate is in the units of the message, and the threshold
// in eighths of a decibel.
struct Line {
    double elevation_deg;
    Waveform waveform;
    int rate;
    int surveillance_prf, surveillance_pulses, doppler_prf, doppler_pulses;
    int threshold_eighth_db;
};

Pattern pattern_of(int number, std::span<const Line> lines) {
    Pattern pattern;
    pattern.number = number;
    for (const Line& line : lines) {
        const bool split = line.waveform == surveillance || line.waveform == doppler;
        Cut cut;
        cut.elevation_deg = nearest_elevation_deg(line.elevation_deg);
        cut.waveform = line.waveform;
        cut.azimuth_rate_deg_s = line.rate * rate_step_deg_s;
        cut.azimuth_spacing_deg = split ? 0.5F : 1.0F;
        cut.surveillance_prf = line.surveillance_prf;
        cut.surveillance_pulses = line.surveillance_pulses;
        cut.doppler_prf = line.doppler_prf;
        cut.doppler_pulses = line.doppler_pulses;
        cut.snr_threshold_db = static_cast<float>(line.threshold_eighth_db) / 8;
        pattern.cuts.push_back(cut);
    }
    return pattern;
}

constexpr Line lines_35[] = {
    {0.4834, surveillance, 3616, 1, 64, 0, 0, 0}, {0.4834, doppler, 10528, 0, 0, 4, 64, 4},
    {0.8789, surveillance, 3616, 1, 64, 0, 0, 0}, {0.8789, doppler, 10528, 0, 0, 4, 64, 4},
    {1.3184, surveillance, 3984, 2, 64, 0, 0, 0}, {1.3184, doppler, 10528, 0, 0, 4, 64, 4},
    {1.8018, batch, 11280, 3, 3, 4, 50, 24},      {2.4170, batch, 12928, 4, 3, 4, 44, 24},
    {3.1201, batch, 12328, 5, 5, 4, 44, 16},      {3.9990, batch, 13160, 6, 5, 4, 42, 16},
    {5.0977, batch, 13160, 6, 5, 4, 42, 8},       {6.4160, batch, 13160, 6, 5, 4, 42, 8},
};

constexpr Line lines_212[] = {
    {0.4834, surveillance, 15400, 1, 15, 0, 0, 16}, {0.4834, doppler, 12305, 0, 0, 6, 64, 28},
    {0.8789, surveillance, 15400, 1, 15, 0, 0, 16}, {0.8789, doppler, 12305, 0, 0, 6, 64, 28},
    {1.3184, surveillance, 15400, 1, 15, 0, 0, 16}, {1.3184, doppler, 12305, 0, 0, 6, 64, 28},
    {1.8018, batch, 17944, 1, 3, 6, 30, 28},        {2.4170, batch, 19224, 2, 3, 6, 31, 28},
    {3.1201, batch, 19224, 2, 3, 6, 31, 28},        {3.9990, batch, 19224, 2, 3, 6, 31, 28},
    {5.0977, batch, 20392, 3, 3, 6, 31, 28},        {6.4160, batch, 20392, 3, 3, 6, 31, 28},
    {7.9980, high, 20680, 0, 0, 6, 38, 28},         {10.0195, high, 21032, 0, 0, 7, 40, 28},
    {12.4805, high, 20928, 0, 0, 8, 44, 28},        {15.6006, high, 20928, 0, 0, 8, 44, 28},
    {19.5117, high, 20928, 0, 0, 8, 44, 28},
};

constexpr Line lines_215[] = {
    {0.4834, surveillance, 8352, 1, 28, 0, 0, 0},  {0.4834, doppler, 11528, 0, 0, 5, 64, 4},
    {0.8789, surveillance, 9736, 1, 24, 0, 0, 0},  {0.8789, doppler, 11528, 0, 0, 5, 64, 4},
    {1.3184, surveillance, 11592, 2, 22, 0, 0, 0}, {1.3184, doppler, 11528, 0, 0, 5, 64, 4},
    {1.8018, batch, 12216, 3, 3, 5, 50, 24},       {2.4170, batch, 15040, 4, 3, 5, 40, 24},
    {3.1201, batch, 14224, 5, 5, 5, 40, 24},       {3.9990, batch, 14736, 6, 5, 5, 40, 24},
    {5.0977, batch, 14736, 6, 5, 5, 40, 24},       {6.4160, batch, 14736, 6, 5, 5, 40, 24},
    {7.9980, high, 18104, 0, 0, 6, 44, 8},         {10.0195, high, 18672, 0, 0, 8, 50, 8},
    {11.9971, high, 18672, 0, 0, 8, 50, 8},        {14.0186, high, 18672, 0, 0, 8, 50, 8},
    {16.6992, high, 18672, 0, 0, 8, 50, 8},        {19.5117, high, 18672, 0, 0, 8, 50, 8},
};

// Returns the facts of the cut's PRF. For a number outside the table, returns the nearest row.
const PrfFacts& facts_of(const Cut& cut) {
    const int number = has_velocity(cut) ? cut.doppler_prf : cut.surveillance_prf;
    return prf_facts[static_cast<std::size_t>(std::clamp(number, 0, 8))];
}

// Returns the bytes of the three Doppler sectors of a cut. They begin at 30, 210 and 335 degrees,
// as in real patterns. Returns zeros if the cut has no velocity.
std::array<std::uint8_t, 22> doppler_sectors(const Cut& cut) {
    std::array<std::uint8_t, 22> rest{};
    if (!has_velocity(cut)) return rest;
    constexpr std::array<std::uint16_t, 3> edges = {0x1558, 0x9558, 0xEE38};
    // A sector has an edge, a PRF and pulses. Two spare bytes follow each sector except the first.
    constexpr std::array<std::size_t, 3> places = {0, 6, 14};
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const std::size_t at = places[i];
        rest[at] = static_cast<std::uint8_t>(edges[i] >> 8);
        rest[at + 1] = static_cast<std::uint8_t>(edges[i] & 0xFF);
        rest[at + 3] = static_cast<std::uint8_t>(cut.doppler_prf);
        rest[at + 5] = static_cast<std::uint8_t>(cut.doppler_pulses);
    }
    return rest;
}

// Returns the flags of message 5: half degree radials (1), 250 m reflectivity (2), Doppler to 300
// km (4). The flag for dual polarization stays off, because simulated radars do not send it.
std::uint8_t resolution_flags(const Cut& cut) {
    unsigned flags = 2;
    if (cut.azimuth_spacing_deg < 1) flags |= 1U;
    if (cut.waveform == Waveform::doppler || cut.waveform == Waveform::batch) flags |= 4U;
    return static_cast<std::uint8_t>(flags);
}

}  // namespace

float nearest_elevation_deg(double elevation_deg) {
    return static_cast<float>(std::round(elevation_deg / elevation_step_deg) * elevation_step_deg);
}

double nearest_rate_deg_s(double rate_deg_s) {
    return std::round(rate_deg_s / rate_step_deg_s) * rate_step_deg_s;
}

const Pattern* find_pattern(int number) {
    static const std::array<Pattern, 3> patterns = {
        pattern_of(35, lines_35), pattern_of(212, lines_212), pattern_of(215, lines_215)};
    const auto found = std::find_if(patterns.begin(), patterns.end(),
                                    [number](const Pattern& p) { return p.number == number; });
    return found == patterns.end() ? nullptr : &*found;
}

std::span<const int> pattern_numbers() {
    static constexpr std::array<int, 3> numbers = {35, 212, 215};
    return numbers;
}

bool has_velocity(const Cut& cut) {
    return cut.waveform != Waveform::surveillance;
}
float nyquist_mps(const Cut& cut) {
    return cut.nyquist_mps > 0 ? cut.nyquist_mps : facts_of(cut).nyquist_mps;
}
float unambiguous_range_m(const Cut& cut) {
    return facts_of(cut).unambiguous_range_m;
}

double duration_s(const Cut& cut) {
    return 360 / cut.azimuth_rate_deg_s + move_s;
}

double duration_s(const Pattern& pattern) {
    double total_s = -move_s;  // the antenna does not move after the last cut
    for (const Cut& cut : pattern.cuts) {
        total_s += duration_s(cut);
    }
    return total_s;
}

level2::Vcp to_message(const Pattern& pattern) {
    level2::Vcp vcp;
    vcp.pattern_number = static_cast<std::uint16_t>(pattern.number);
    vcp.version = 1;
    vcp.clutter_group = 1;
    vcp.doppler_resolution = 2;  // 0.5 m/s
    vcp.pulse_width = 2;         // short
    for (const Cut& cut : pattern.cuts) {
        level2::VcpCut sent;
        sent.elevation_deg = cut.elevation_deg;
        sent.channel_configuration = cut.azimuth_spacing_deg < 1 ? 2 : 0;
        sent.waveform = static_cast<std::uint8_t>(cut.waveform);
        sent.super_resolution = resolution_flags(cut);
        sent.surveillance_prf = static_cast<std::uint8_t>(cut.surveillance_prf);
        sent.surveillance_pulses = static_cast<std::uint16_t>(cut.surveillance_pulses);
        sent.azimuth_rate_code =
            static_cast<std::int16_t>(std::lround(cut.azimuth_rate_deg_s / rate_step_deg_s));
        sent.thresholds_eighth_db.fill(
            static_cast<std::int16_t>(std::lround(cut.snr_threshold_db * 8)));
        sent.rest = doppler_sectors(cut);
        vcp.cuts.push_back(sent);
    }
    return vcp;
}

}  // namespace stormcellar::synth
