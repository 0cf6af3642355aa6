// stormcellar/grid/refractivity.h -- how the radio refractivity of the air changes with height.
//
// Units   height above mean sea level in metres; refractivity N = (n - 1) 1e6 in N-units, n being
//         the index of refraction; its gradient in N-units per metre (the literature's: per km).
// Model   spherical layers: N is the same all around the site. Inside a layer N is linear or
//         exponential in height; N is continuous, dN/dh jumps between layers.
// Source  Bean and Dutton, Radio Meteorology (1966): the exponential reference atmosphere;
//         Recommendation ITU-R P.453: from pressure, temperature and humidity
//         (grid/beam/sounding.h).
// Threads immutable and cheap to copy (copies share their layers).
// Not covered: what changes along the beam, as fronts and outflows; precipitation.
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "stormcellar/base/result.h"

namespace stormcellar::grid {

// N(h) = n_units exp(rate (h - from_m)) + gradient (h - from_m); of rate and gradient one is zero.
struct RefractivityLayer {
    double top_m =
        std::numeric_limits<double>::infinity();  // it begins at the top of the one below
    double from_m = 0;
    double n_units = 0;
    double gradient_per_m = 0;
    double rate_per_m = 0;

    struct Refractivity {
        double n_units = 0;
        double gradient_per_m = 0;
    };
    // Also outside of the layer, as its formula goes on.
    [[nodiscard]] Refractivity at(double height_m) const noexcept {
        const double above_m = height_m - from_m;
        if (rate_per_m == 0) return {n_units + gradient_per_m * above_m, gradient_per_m};
        const double here = n_units * std::exp(rate_per_m * above_m);
        return {here, rate_per_m * here};
    }
};

struct RefractivityLevel {
    double height_m = 0;
    double n_units = 0;
};

class RefractivityProfile {
  public:
    // What a profile may hold. No gradient of 2 N-units per metre was ever measured over metres.
    static constexpr double least_height_m = -500;
    static constexpr double greatest_height_m = 100'000;
    static constexpr double highest_first_level_m = 9000;
    static constexpr double greatest_n_units = 1000;
    static constexpr double greatest_gradient_per_m = 2;
    static constexpr std::size_t greatest_level_count = 10'000;

    // The exponential reference atmosphere: N0 and the scale height H of the CRPL's mean.
    static constexpr double reference_n_units = 313;
    static constexpr double reference_scale_m = 7350;

    // What the 4/3 earth stands for: 313 at sea level, falling by 1e6 / (4 R) per metre (39.2 per
    // km), R the Gaussian radius at the latitude, up to where nothing is left (8.0 km); vacuum
    // above.
    [[nodiscard]] static RefractivityProfile standard(double latitude_deg);
    // exponential() with its defaults: what is taken where nothing else is known.
    [[nodiscard]] static RefractivityProfile reference();
    // N0 exp(-h / H). bad_argument unless N0 is 0 to 1000 and H is 1 to 100 km.
    [[nodiscard]] static Result<RefractivityProfile> exponential(
        double n_units = reference_n_units, double scale_m = reference_scale_m);
    // Between levels N is exponential. Above the last it falls with the reference's scale height;
    // below the first the gradient there goes on. bad_argument unless there are 2 to 10,000 levels
    // of strictly rising height within the limits above, N above 0; `name` is what name() says.
    [[nodiscard]] static Result<RefractivityProfile> from_levels(
        std::span<const RefractivityLevel> levels, std::string name);

    // NaN in, NaN out. At a border between layers the upper one counts.
    [[nodiscard]] RefractivityLayer::Refractivity at(double height_m) const noexcept {
        return layer(layer_index(height_m)).at(height_m);
    }
    // Layers are numbered upwards; the lowest reaches down, the highest up for ever. Of
    // from_levels() the lowest ends at the first level.
    [[nodiscard]] std::size_t layer_index(double height_m) const noexcept;
    [[nodiscard]] const RefractivityLayer& layer(std::size_t index) const noexcept {
        return (*layers_)[index];
    }
    // For provenance: "exponential N0 313 H 7350 m".
    [[nodiscard]] const std::string& name() const noexcept { return *name_; }

  private:
    RefractivityProfile(std::vector<RefractivityLayer> layers, std::string name);

    std::shared_ptr<const std::vector<RefractivityLayer>> layers_;  // never empty
    std::shared_ptr<const std::string> name_;
};

}  // namespace stormcellar::grid
