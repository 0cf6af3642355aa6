#include "synth/synth_effects.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "synth/truth.h"

namespace stormcellar::synth {
namespace {

constexpr double most_normal = 6.8;  // the largest number that normals_of() returns

double linear(double db) {
    return std::pow(10, db / 10);
}

}  // namespace

double noisy_dbz(double dbz, double noise_level_dbz, double noise_db, double normal) {
    const double k = noise_db * std::numbers::ln10 / 10;
    const double noise = linear(noise_level_dbz);
    const double power = (linear(dbz) + noise) * std::exp(k * normal - k * k / 2);
    return power > noise ? 10 * std::log10(power - noise) : no_echo_dbz;
}

double velocity_deviation_mps(double dbz, double noise_level_dbz, double velocity_noise_mps) {
    return velocity_noise_mps * (1 + linear(noise_level_dbz - dbz));
}

double wrapped_mps(double velocity_mps, double nyquist_mps) {
    const double turns = std::floor((velocity_mps + nyquist_mps) / (2 * nyquist_mps));
    const double wrapped = velocity_mps - turns * 2 * nyquist_mps;
    // Rounding may have moved the velocity to the end of the interval.
    return wrapped < nyquist_mps ? wrapped : -nyquist_mps;
}

int fold_number(double true_mps, double shown_mps, double nyquist_mps) {
    return static_cast<int>(std::lround((true_mps - shown_mps) / (2 * nyquist_mps)));
}

std::vector<bool> overlaid_gates(std::span<const double> power, double gates_a_trip,
                                 double threshold_db) {
    std::vector<bool> folded(power.size(), false);
    const auto gates = static_cast<long>(power.size());
    const double factor = linear(threshold_db);
    for (long gate = 0; gate < gates; ++gate) {
        const double own = power[static_cast<std::size_t>(gate)];
        if (own <= 0) continue;
        double others = 0;
        for (int trip = 1;; ++trip) {
            const long away = std::lround(trip * gates_a_trip);
            if (away <= 0 || away >= gates) break;
            if (gate >= away) others += power[static_cast<std::size_t>(gate - away)];
            if (gate + away < gates) others += power[static_cast<std::size_t>(gate + away)];
        }
        folded[static_cast<std::size_t>(gate)] = own < factor * others;
    }
    return folded;
}

double clutter_dbz(const Clutter& clutter, std::uint32_t seed, const ClutterBeam& beam,
                   double range_m) {
    constexpr double cells_a_degree = 2;
    constexpr double cell_m = 250;
    const double up = std::max(0.0, beam.elevation_deg) / beam.beam_width_deg;
    const double smooth_dbz = clutter.peak_dbz -
                              (clutter.peak_dbz - edge_dbz) * range_m / clutter.range_m -
                              80 * std::log10(2.0) * up * up;
    if (smooth_dbz + clutter.texture_db * most_normal < weakest_dbz) return no_echo_dbz;
    DrawPlace ground;
    ground.radial = static_cast<std::uint32_t>(beam.azimuth_deg * cells_a_degree);
    ground.gate = static_cast<std::uint32_t>(range_m / cell_m);
    const RandomWords words = draw(seed, Draw::clutter, ground);
    const double dbz = smooth_dbz + clutter.texture_db * normals_of(words[0], words[1]).first;
    return dbz < weakest_dbz ? no_echo_dbz : dbz;
}

double clutter_reach_m(const Clutter& clutter) {
    const double most_dbz = clutter.peak_dbz + clutter.texture_db * most_normal;
    return clutter.range_m * (most_dbz - weakest_dbz) / (clutter.peak_dbz - edge_dbz);
}

GateEcho sum_of(const GateEcho& a, const GateEcho& b) {
    if (b.dbz == no_echo_dbz) return a;
    if (a.dbz == no_echo_dbz) return b;
    const double z_a = linear(a.dbz);
    const double z_b = linear(b.dbz);
    const double share_a = z_a / (z_a + z_b);
    const double share_b = z_b / (z_a + z_b);
    const double apart_mps = a.away_mps - b.away_mps;
    const double variance = share_a * a.width_mps * a.width_mps +
                            share_b * b.width_mps * b.width_mps +
                            share_a * share_b * apart_mps * apart_mps;
    return {10 * std::log10(z_a + z_b), share_a * a.away_mps + share_b * b.away_mps,
            std::sqrt(variance)};
}

Jitter jitter_at(std::uint32_t seed, int volume, int cut, double since_start_s) {
    constexpr double periods_s[] = {7.3, 3.1, 1.7};
    Jitter jitter;
    DrawPlace place;
    place.volume = static_cast<std::uint32_t>(volume);
    place.cut = static_cast<std::uint32_t>(cut);
    for (const double period_s : periods_s) {
        const RandomWords words = draw(seed, Draw::jitter, place);
        const double turns = since_start_s / period_s;
        jitter.azimuth += std::sin(2 * std::numbers::pi * (turns + uniform_of(words[0]))) / 3;
        jitter.elevation += std::sin(2 * std::numbers::pi * (turns + uniform_of(words[1]))) / 3;
        ++place.radial;  // for the next wave
    }
    return jitter;
}

bool is_missing(const Instrument& instrument, const RadialPlace& place) {
    const auto& cuts = instrument.missing_cuts;
    if (std::find(cuts.begin(), cuts.end(), place.cut) != cuts.end()) return true;
    const auto after = [](double from_deg, double to_deg) {
        const double turn_deg = std::fmod(to_deg - from_deg, 360);
        return turn_deg < 0 ? turn_deg + 360 : turn_deg;
    };
    for (const MissingSector& sector : instrument.missing_radials) {
        if (sector.cut && *sector.cut != place.cut) continue;
        if (sector.to_deg - sector.from_deg >= 360 ||
            after(sector.from_deg, place.azimuth_deg) <= after(sector.from_deg, sector.to_deg)) {
            return true;
        }
    }
    if (instrument.missing_fraction <= 0) return false;
    const RandomWords words =
        draw(instrument.seed, Draw::missing,
             {static_cast<std::uint32_t>(place.volume), static_cast<std::uint32_t>(place.cut),
              static_cast<std::uint32_t>(place.radial), 0});
    return uniform_of(words[0]) < instrument.missing_fraction;
}

bool is_missing_gate(const Instrument& instrument, const DrawPlace& place) {
    if (instrument.missing_gate_fraction <= 0) return false;
    const RandomWords words = draw(instrument.seed, Draw::gate_loss, place);
    return uniform_of(words[0]) < instrument.missing_gate_fraction;
}

std::optional<GateEcho> speckle_at(const Instrument& instrument, const DrawPlace& place,
                                   double limit_dbz, double nyquist_mps) {
    constexpr double most_over_db = 10;
    if (instrument.speckle_fraction <= 0) return std::nullopt;
    const RandomWords words = draw(instrument.seed, Draw::gate_loss, place);
    if (uniform_of(words[1]) >= instrument.speckle_fraction) return std::nullopt;
    return GateEcho{limit_dbz + most_over_db * uniform_of(words[2]),
                    nyquist_mps * (2 * uniform_of(words[3]) - 1), noise_width_mps(nyquist_mps)};
}

double noise_width_mps(double nyquist_mps) {
    return nyquist_mps / std::numbers::sqrt3;
}

}  // namespace stormcellar::synth
