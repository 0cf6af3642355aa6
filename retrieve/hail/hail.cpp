#include "stormcellar/retrieve/hail.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace stormcellar::retrieve {
namespace {

constexpr double share_of_flux = 0.1;  // SHI divided by the integral of the flux

// Integrates the weight of temperature over height, up to a height. The weight is 0 below the level
// of 0 C and 1 above the level of -20 C; it rises evenly between the two.
double weight_up_to(double height_m, const FreezingLevels& levels) {
    const double depth_m = levels.minus_20_c_m - levels.zero_c_m;
    const double above_m = height_m - levels.zero_c_m;
    if (above_m <= 0) return 0;
    if (above_m < depth_m) return above_m * above_m / (2 * depth_m);
    return above_m - depth_m / 2;
}

Result<void> validate_heights(std::span<const double> heights_m) {
    if (heights_m.size() < 2)
        return fail(ErrorCode::bad_argument, "a column of {} heights has no layers of known depth",
                    heights_m.size());
    for (std::size_t i = 0; i < heights_m.size(); ++i) {
        if (!std::isfinite(heights_m[i]))
            return fail(ErrorCode::bad_argument, "a height of a column is not a number");
        if (i > 0 && heights_m[i] <= heights_m[i - 1])
            return fail(ErrorCode::bad_argument, "the heights of a column must grow");
    }
    return {};
}

std::vector<double> layer_weights(std::span<const double> heights_m, const FreezingLevels& levels) {
    const std::size_t last = heights_m.size() - 1;
    std::vector<double> weights_m(heights_m.size());
    double below = weight_up_to(heights_m[0] - (heights_m[1] - heights_m[0]) / 2, levels);
    for (std::size_t i = 0; i <= last; ++i) {
        const double half_m = i < last ? (heights_m[i + 1] - heights_m[i]) / 2
                                       : (heights_m[last] - heights_m[last - 1]) / 2;
        const double above = weight_up_to(heights_m[i] + half_m, levels);
        weights_m[i] = share_of_flux * (above - below);
        below = above;
    }
    return weights_m;
}

double index_of(std::span<const double> weights_m, std::span<const float> dbz) {
    double sum = 0;
    for (std::size_t i = 0; i < std::min(weights_m.size(), dbz.size()); ++i)
        sum += weights_m[i] * hail_energy_flux(static_cast<double>(dbz[i]));
    return sum;
}

float witt_size_mm(double shi) {
    return static_cast<float>(2.54 * std::sqrt(shi));
}

}  // namespace

Result<void> validate(const FreezingLevels& levels) {
    const double depth_m = levels.minus_20_c_m - levels.zero_c_m;
    if (!(levels.zero_c_m >= -1000 && levels.zero_c_m <= 7000))
        return fail(ErrorCode::bad_argument, "the level of 0 C must be from -1000 to 7000 m");
    if (!(depth_m >= 1000 && depth_m <= 8000))
        return fail(ErrorCode::bad_argument,
                    "the level of -20 C must be 1000 to 8000 m above that of 0 C");
    return {};
}

Result<HailLayers> hail_layers(std::span<const double> heights_m, const FreezingLevels& levels,
                               double radar_m) {
    if (auto valid = validate(levels); !valid) return pass_on(valid);
    if (auto valid = validate_heights(heights_m); !valid) return pass_on(valid);
    if (!std::isfinite(radar_m))
        return fail(ErrorCode::bad_argument, "the height of the radar is not a number");
    return HailLayers{layer_weights(heights_m, levels),
                      std::max(57.5 * (levels.zero_c_m - radar_m) / 1000 - 121, 20.0)};
}

double hail_energy_flux(double dbz) {
    constexpr double rain_dbz = 40, hail_dbz = 50, most_dbz = 100;
    if (!(dbz > rain_dbz)) return 0;
    const double weight = std::min((dbz - rain_dbz) / (hail_dbz - rain_dbz), 1.0);
    return 5e-6 * std::pow(10.0, 0.084 * std::min(dbz, most_dbz)) * weight;
}

Hail hail_of_column(const HailLayers& layers, std::span<const float> dbz) {
    return hail_of_shi(index_of(layers.weights_m, dbz), layers.warning_threshold);
}

Hail hail_of_shi(double shi, double warning_threshold) {
    if (!(shi > 0 && warning_threshold > 0) || !std::isfinite(shi)) return {};
    const double posh = 29 * std::log(shi / warning_threshold) + 50;
    return {.shi_j_per_m_s = static_cast<float>(shi),
            .posh_percent = static_cast<float>(std::clamp(posh, 0.0, 100.0)),
            .mesh_mm = witt_size_mm(shi),
            .mesh75_mm = static_cast<float>(15.096 * std::pow(shi, 0.206)),
            .mesh95_mm = static_cast<float>(22.157 * std::pow(shi, 0.212))};
}

Result<MeshRange> mesh_range(std::span<const double> heights_m, std::span<const float> dbz,
                             const FreezingLevels& levels, double error_m) {
    if (auto valid = validate(levels); !valid) return pass_on(valid);
    if (auto valid = validate_heights(heights_m); !valid) return pass_on(valid);
    if (!(error_m >= 0) || !std::isfinite(error_m))
        return fail(ErrorCode::bad_argument, "an error of the levels must be at least 0 m");
    const auto size_at = [&](double shift_m) {
        const FreezingLevels moved{levels.zero_c_m + shift_m, levels.minus_20_c_m + shift_m};
        return witt_size_mm(index_of(layer_weights(heights_m, moved), dbz));
    };
    return MeshRange{.least_mm = size_at(error_m), .most_mm = size_at(-error_m)};
}

}  // namespace stormcellar::retrieve
