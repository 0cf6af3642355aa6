#include "stormcellar/grid/refractivity.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/floating_point.h"
#include "stormcellar/grid/beam_geometry.h"

namespace stormcellar::grid {
namespace {

// Returns what is wrong with a level above the level `below`; empty if nothing is wrong.
std::string complaint(const RefractivityLevel& level, const RefractivityLevel* below) {
    using Profile = RefractivityProfile;
    if (!is_within(level.height_m, Profile::least_height_m, Profile::greatest_height_m)) {
        return fmt::format("height {} m is not from {} to {} m", level.height_m,
                           Profile::least_height_m, Profile::greatest_height_m);
    }
    if (!is_within(level.n_units, 0.0, Profile::greatest_n_units) || level.n_units == 0) {
        return fmt::format("refractivity {} is not above 0 and at most {}", level.n_units,
                           Profile::greatest_n_units);
    }
    if (below == nullptr) {
        if (level.height_m <= Profile::highest_first_level_m) return {};
        return fmt::format("the first level, at {} m, is above {} m", level.height_m,
                           Profile::highest_first_level_m);
    }
    const double rise_m = level.height_m - below->height_m;
    if (!(rise_m > 0)) {
        return fmt::format("height {} m is not above the one before, {} m", level.height_m,
                           below->height_m);
    }
    const double gradient = (level.n_units - below->n_units) / rise_m;
    if (!(std::abs(gradient) <= Profile::greatest_gradient_per_m)) {
        return fmt::format("refractivity changes by {:.3g} per meter below {} m, more than {}",
                           gradient, level.height_m, Profile::greatest_gradient_per_m);
    }
    return {};
}

}  // namespace

RefractivityProfile::RefractivityProfile(std::vector<RefractivityLayer> layers, std::string name)
    : layers_(std::make_shared<const std::vector<RefractivityLayer>>(std::move(layers))),
      name_(std::make_shared<const std::string>(std::move(name))) {}

RefractivityProfile RefractivityProfile::standard(double latitude_deg) {
    const double fall_per_m = 1e6 / (4 * gaussian_radius_m(latitude_deg));
    RefractivityLayer air;
    air.n_units = reference_n_units;
    air.gradient_per_m = -fall_per_m;
    air.top_m = reference_n_units / fall_per_m;
    RefractivityLayer vacuum{.from_m = air.top_m};
    return {{air, vacuum}, "standard gradient"};
}

RefractivityProfile RefractivityProfile::reference() {
    return exponential().value();
}

Result<RefractivityProfile> RefractivityProfile::exponential(double n_units, double scale_m) {
    if (!is_within(n_units, 0.0, greatest_n_units)) {
        return fail(ErrorCode::bad_argument, "refractivity {} at sea level is not from 0 to {}",
                    n_units, greatest_n_units);
    }
    if (!is_within(scale_m, 1000.0, 100'000.0)) {
        return fail(ErrorCode::bad_argument, "scale height {} m is not from 1 to 100 km", scale_m);
    }
    RefractivityLayer layer{.n_units = n_units, .rate_per_m = -1 / scale_m};
    return RefractivityProfile({layer},
                               fmt::format("exponential N0 {:g} H {:g} m", n_units, scale_m));
}

Result<RefractivityProfile> RefractivityProfile::from_levels(
    std::span<const RefractivityLevel> levels, std::string name) {
    if (levels.size() < 2 || levels.size() > greatest_level_count) {
        return fail(ErrorCode::bad_argument, "the refractivity profile has {} levels, not 2 to {}",
                    levels.size(), greatest_level_count);
    }
    for (std::size_t i = 0; i < levels.size(); ++i) {
        const std::string wrong = complaint(levels[i], i > 0 ? &levels[i - 1] : nullptr);
        if (!wrong.empty()) return fail(ErrorCode::bad_argument, "level {}: {}", i + 1, wrong);
    }
    std::vector<RefractivityLayer> layers;
    layers.reserve(levels.size() + 1);
    for (std::size_t i = 0; i < levels.size(); ++i) {
        RefractivityLayer layer{.from_m = levels[i].height_m, .n_units = levels[i].n_units};
        if (i + 1 < levels.size()) {
            layer.top_m = levels[i + 1].height_m;
            layer.rate_per_m =
                std::log(levels[i + 1].n_units / layer.n_units) / (layer.top_m - layer.from_m);
        } else {
            layer.rate_per_m = -1 / reference_scale_m;
        }
        layers.push_back(layer);
    }
    RefractivityLayer lowest;
    lowest.top_m = lowest.from_m = levels[0].height_m;
    lowest.n_units = levels[0].n_units;
    lowest.gradient_per_m = layers[0].at(lowest.from_m).gradient_per_m;
    layers.insert(layers.begin(), lowest);
    return RefractivityProfile(std::move(layers), std::move(name));
}

std::size_t RefractivityProfile::layer_index(double height_m) const noexcept {
    const auto above = std::upper_bound(layers_->begin(), layers_->end() - 1, height_m,
                                        [](double height, const RefractivityLayer& layer) {
                                            return std::isless(height, layer.top_m);
                                        });
    return static_cast<std::size_t>(above - layers_->begin());
}

}  // namespace stormcellar::grid
