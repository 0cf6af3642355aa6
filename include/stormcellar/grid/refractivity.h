// stormcellar/grid/refractivity.h -- how the radio refractivity of the air changes with height.
//
// Units     Heights in meters above mean sea level; refractivity N = (n - 1) 1e6 in N-units, where
//           n is the index of refraction; gradients of N in N-units per meter (the literature has
//           N-units per km).
// Model     Spherical layers: N is the same all around the site. Inside a layer N is linear or
//           exponential in height. N is continuous; dN/dh jumps between layers. The model does not
//           cover changes along the beam (fronts, outflows) or precipitation.
// Source    Bean and Dutton, Radio Meteorology (1966), for the exponential reference atmosphere;
//           Recommendation ITU-R P.453 for N from pressure, temperature and humidity
//           (grid/beam/sounding.h).
// Threads   Immutable and cheap to copy (copies share their layers); any thread may use it.
// Errors    Functions that return a Result return bad_argument. Otherwise NaN in, NaN out.
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

// A layer in which N(h) = n_units exp(rate (h - from_m)) + gradient (h - from_m), where the rate or
// the gradient is 0.
struct RefractivityLayer {
    double top_m =
        std::numeric_limits<double>::infinity();  // it begins at the top of the layer below
    double from_m = 0;
    double n_units = 0;
    double gradient_per_m = 0;
    double rate_per_m = 0;

    struct Refractivity {
        double n_units = 0;
        double gradient_per_m = 0;
    };
    // Evaluates the formula of the layer, at heights outside the layer too.
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
    // The limits of a profile. No measured gradient over several meters comes near 2 N-units per
    // meter.
    static constexpr double least_height_m = -500;
    static constexpr double greatest_height_m = 100'000;
    static constexpr double highest_first_level_m = 9000;
    static constexpr double greatest_n_units = 1000;
    static constexpr double greatest_gradient_per_m = 2;
    static constexpr std::size_t greatest_level_count = 10'000;

    // The exponential reference atmosphere: the CRPL's mean N0 and scale height H.
    static constexpr double reference_n_units = 313;
    static constexpr double reference_scale_m = 7350;

    // Returns the profile that the 4/3 earth assumes: 313 at sea level, falling by 1e6 / (4 R) per
    // meter (39.2 per km), where R is the Gaussian radius at the latitude, down to 0 (at 8.0 km).
    // Above that height there is a vacuum.
    [[nodiscard]] static RefractivityProfile standard(double latitude_deg);
    // Returns exponential() with its defaults. Use it if nothing better is known.
    [[nodiscard]] static RefractivityProfile reference();
    // Returns N0 exp(-h / H). Returns bad_argument unless N0 is 0 to 1000 and H is 1 to 100 km.
    [[nodiscard]] static Result<RefractivityProfile> exponential(
        double n_units = reference_n_units, double scale_m = reference_scale_m);
    // Returns a profile through levels, between which N is exponential. Above the last level, N
    // falls with the scale height of the reference atmosphere. Below the first level, N is linear,
    // with the gradient just above the first level. Returns bad_argument unless there are 2 to
    // 10,000 levels of strictly rising height, N is above 0 in each, and heights, N and gradients
    // keep the limits above.
    [[nodiscard]] static Result<RefractivityProfile> from_levels(
        std::span<const RefractivityLevel> levels, std::string name);

    // Evaluates the profile: NaN in, NaN out. At a border between layers, evaluates the upper
    // layer.
    [[nodiscard]] RefractivityLayer::Refractivity at(double height_m) const noexcept {
        return layer(layer_index(height_m)).at(height_m);
    }
    // Returns the number of the layer at a height. Layers are numbered upward. The lowest layer has
    // no lower end and the highest no upper end. In a profile from from_levels(), the lowest layer
    // ends at the first level.
    [[nodiscard]] std::size_t layer_index(double height_m) const noexcept;
    [[nodiscard]] const RefractivityLayer& layer(std::size_t index) const noexcept {
        return (*layers_)[index];
    }
    // Returns a name for provenance: "exponential N0 313 H 7350 m".
    [[nodiscard]] const std::string& name() const noexcept { return *name_; }

  private:
    RefractivityProfile(std::vector<RefractivityLayer> layers, std::string name);

    std::shared_ptr<const std::vector<RefractivityLayer>> layers_;  // never empty
    std::shared_ptr<const std::string> name_;
};

}  // namespace stormcellar::grid
