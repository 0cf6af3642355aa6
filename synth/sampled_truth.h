// synth/sampled_truth.h -- samples the truth of a scene at a time in UTC.
//
// It returns the echo at places on the earth or at places seen from the scene's radar, and the
// radial velocity as seen from any site.
//
// Units     Degrees (WGS84), meters, heights above mean sea level, m/s positive away from the site.
// Model     The weather is in the azimuthal equidistant plane about the scene's radar
//           (stormcellar/grid/site_frame.h), so azimuth and arc from there are exact. East and
//           north of a motion are directions in that plane. Radial velocity is the component of the
//           wind away from the site, or of the motion of the features if there is no wind, times
//           the cosine of the elevation at the antenna, as in synth/observe.h. From any other site,
//           directions are also those of the plane. Across the radius, the scale of the plane errs
//           by (arc / earth radius)^2 / 6, which is 0.02 % at 230 km.
// Accuracy  Places are within 1e-6 m up to 500 km away; echo is as in synth/truth.h. Enforced by
//           tests/synth/sampled_truth_test.cpp.
// Threads   Immutable; the scene must outlive it.
#pragma once

#include <optional>

#include "synth/synth_scene.h"

namespace stormcellar::synth {

struct Place {
    double latitude_deg = 0;
    double longitude_deg = 0;
    double height_m = 0;
};

// A point in the coordinates of the gridder: in the vertical plane through the scene's radar at an
// azimuth.
struct PolarPlace {
    double azimuth_deg = 0;
    double arc_m = 0;  // along the earth at sea level
    double height_m = 0;
};

class SampledTruth {
  public:
    explicit SampledTruth(const Scene& scene) : scene_(scene) {}

    // Returns the seconds since the start of the scene; they are negative before it.
    [[nodiscard]] double seconds_at(UtcTime time) const;
    // Returns the place in the plane of the scene.
    [[nodiscard]] Point point_of(const Place& place) const;
    [[nodiscard]] static Point point_of(const PolarPlace& place);

    // Returns the echo; minus infinity dBZ if there is nothing.
    [[nodiscard]] Echo at(const Place& place, UtcTime time) const;
    [[nodiscard]] Echo at(const PolarPlace& place, UtcTime time) const;

    // Returns the velocity, without aliasing, that a radar at `site` without instrument effects
    // would measure at `place`, or none if there is no echo. `site` has the height of its antenna.
    [[nodiscard]] std::optional<double> radial_velocity_mps(const Place& place, const Place& site,
                                                            UtcTime time) const;
    // Returns the same for the scene's radar.
    [[nodiscard]] std::optional<double> radial_velocity_mps(const PolarPlace& place,
                                                            UtcTime time) const;

  private:
    const Scene& scene_;
};

}  // namespace stormcellar::synth
