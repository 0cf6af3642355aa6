#include "stormcellar/retrieve/wind_profile.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "base/degree.h"
#include "base/floating_point.h"
#include "retrieve/dealias/velocity_sheet.h"
#include "retrieve/wind/companion_moment.h"
#include "retrieve/wind/folded_wind.h"
#include "retrieve/wind/vvp_fit.h"

namespace stormcellar::retrieve {
namespace {

constexpr double least_bird_rms_mps = 1, least_bird_rms_single_mps = 2;
constexpr float most_bird_correlation = 0.95F;
constexpr double most_bird_height_m = 5'000;

struct LayerGates {
    std::vector<VvpGate> gates;
    std::vector<float> correlations;  // NaN where there is none
};

Status check(const WindProfileOptions& options) {
    if (!is_within(options.layer_m, 50.0, 2'000.0))
        return fail(ErrorCode::bad_argument, "a layer of wind is 50 to 2000 m thick, not {} m",
                    options.layer_m);
    if (!is_within(options.top_m, options.layer_m, 30'000.0))
        return fail(ErrorCode::bad_argument,
                    "the top of a wind profile is at most 30000 m and above its first layer, "
                    "not {} m",
                    options.top_m);
    if (!is_within(options.least_range_m, 0.0, 300'000.0) ||
        !is_within(options.most_range_m, options.least_range_m, 300'000.0))
        return fail(ErrorCode::bad_argument,
                    "the ranges of a wind profile are within 0 to 300 km, not {} to {} m",
                    options.least_range_m, options.most_range_m);
    return {};
}

// Returns the fold numbers of a sheet's moment, or null if they do not fit the volume.
const SweepFolds* folds_of(const Dealiased& dealiased, const level2::Volume& volume,
                           const VelocitySheet& sheet) {
    const auto found = std::ranges::find_if(dealiased.sweeps, [&](const SweepFolds& folds) {
        return folds.sweep == sheet.sweep && folds.moment == sheet.moment;
    });
    if (found == dealiased.sweeps.end()) return nullptr;
    const std::size_t size =
        volume.sweeps[sheet.sweep].radials.size() * static_cast<std::size_t>(sheet.gates);
    return found->folds.size() == size && found->ambiguous.size() == size ? &*found : nullptr;
}

// Adds the gates of a sheet to the layers of their heights.
void add_gates(const level2::Volume& volume, const VelocitySheet& sheet, const SweepFolds& folds,
               const WindProfileOptions& options, std::span<LayerGates> layers) {
    const CompanionMoment correlation(volume, level2::Moment::rho, sheet);
    const std::vector<float> heights = gate_heights_m(sheet);
    const double level = std::cos(sheet.elevation_deg * degree);
    VvpGate gate;
    gate.up = static_cast<float>(std::sin(sheet.elevation_deg * degree));
    gate.nyquist_mps = static_cast<float>(sheet.turn_mps / 2);
    for (int radial = 0; radial < sheet.radials; ++radial) {
        const auto azimuth =
            static_cast<double>(sheet.azimuths_deg[static_cast<std::size_t>(radial)]);
        gate.east = static_cast<float>(std::sin(azimuth * degree) * level);
        gate.north = static_cast<float>(std::cos(azimuth * degree) * level);
        gate.sector = static_cast<std::uint8_t>(
            std::min(static_cast<int>(azimuth / 360 * VvpGate::sectors), VvpGate::sectors - 1));
        for (int i = 0; i < sheet.gates; ++i) {
            const float turns = sheet.row(radial)[i];
            const double range = sheet.first_gate_m + i * sheet.gate_spacing_m;
            const auto layer = static_cast<std::ptrdiff_t>(std::floor(
                static_cast<double>(heights[static_cast<std::size_t>(i)]) / options.layer_m));
            if (std::isnan(turns) || range < options.least_range_m ||
                range > options.most_range_m || layer < 0 ||
                layer >= static_cast<std::ptrdiff_t>(layers.size()))
                continue;
            const std::size_t at = sheet.at(static_cast<int>(sheet.first_radial) + radial, i);
            if (folds.ambiguous[at] != 0) continue;
            gate.velocity_mps =
                static_cast<float>((static_cast<double>(turns) + folds.folds[at]) * sheet.turn_mps);
            LayerGates& of = layers[static_cast<std::size_t>(layer)];
            of.gates.push_back(gate);
            of.correlations.push_back(correlation.at(radial, range));
        }
    }
}

// Returns the median of the values of the gates in use, or none if less than half of these gates
// have a value.
std::optional<float> median(const std::vector<float>& values,
                            const std::vector<std::uint8_t>& was_used) {
    std::vector<float> of_used;
    std::size_t used = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (was_used[i] == 0) continue;
        ++used;
        if (!std::isnan(values[i])) of_used.push_back(values[i]);
    }
    if (of_used.empty() || 2 * of_used.size() < used) return std::nullopt;
    const auto middle = of_used.begin() + static_cast<std::ptrdiff_t>(of_used.size() / 2);
    std::ranges::nth_element(of_used, middle);
    return *middle;
}

Birds birds_of(const LayerGates& layer, const VvpFit& fit, double height_m) {
    const double rms = fit.wind.rms_mps;
    if (const auto correlation = median(layer.correlations, fit.was_used)) {
        const bool is_likely = rms >= least_bird_rms_mps && *correlation < most_bird_correlation;
        return is_likely ? Birds::likely : Birds::none;
    }
    const bool is_possible = rms >= least_bird_rms_single_mps && height_m < most_bird_height_m;
    return is_possible ? Birds::possible : Birds::none;
}

// Returns true if the volume has velocities, but no Nyquist velocity for any of them.
bool lacks_nyquist(const level2::Volume& volume) {
    bool has_velocity = false;
    for (const level2::Sweep& sweep : volume.sweeps) {
        if (sweep.find(level2::Moment::vel) == nullptr) continue;
        has_velocity = true;
        for (const level2::Radial& radial : sweep.radials)
            if (std::isgreater(radial.nyquist_mps, 0.0F)) return false;
    }
    return has_velocity;
}

}  // namespace

std::string_view text_of(NoWind reason) {
    switch (reason) {
        case NoWind::no_echo:
            return "no echo";
        case NoWind::no_nyquist:
            return "no Nyquist velocity";
        case NoWind::too_few_gates:
            return "too few gates";
        case NoWind::azimuth_gap:
            return "azimuths missing";
        case NoWind::clutter:
            return "clutter or calm";
        case NoWind::scattered:
            return "velocities scattered";
    }
    return "unknown";
}

double Motion::speed_mps() const {
    return std::hypot(u_mps, v_mps);
}

double Motion::direction_deg() const {
    if (u_mps == 0 && v_mps == 0) return 0;
    const double from = std::atan2(-u_mps, -v_mps) / degree;
    return from < 0 ? from + 360 : from;
}

Result<std::vector<WindLayer>> wind_profile(const level2::Volume& volume,
                                            const Dealiased& dealiased,
                                            const WindProfileOptions& options) {
    if (Status good = check(options); !good) return pass_on(good);
    const auto count = static_cast<std::size_t>(std::ceil(options.top_m / options.layer_m));
    std::vector<LayerGates> gates(count);
    const std::vector<VelocitySheet> sheets = velocity_sheets(volume);
    for (const VelocitySheet& sheet : sheets) {
        const SweepFolds* folds = folds_of(dealiased, volume, sheet);
        if (folds == nullptr)
            return fail(ErrorCode::bad_argument, "the fold numbers are not of this volume");
        add_gates(volume, sheet, *folds, options, gates);
    }
    const NoWind nothing = lacks_nyquist(volume) ? NoWind::no_nyquist : NoWind::no_echo;
    std::vector<WindLayer> layers(count);
    for (std::size_t i = 0; i < count; ++i) {
        WindLayer& layer = layers[i];
        layer.bottom_m = static_cast<double>(i) * options.layer_m;
        layer.top_m = layer.bottom_m + options.layer_m;
        if (gates[i].gates.empty()) {
            layer.wind = tl::unexpected(nothing);
            continue;
        }
        const auto fit = fit_vvp(gates[i].gates);
        if (!fit) {
            layer.wind = tl::unexpected(fit.error());
            continue;
        }
        layer.wind = fit->wind;
        layer.wind->birds = birds_of(gates[i], *fit, layer.middle_m());
    }
    return layers;
}

}  // namespace stormcellar::retrieve
