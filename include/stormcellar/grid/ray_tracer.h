// stormcellar/grid/ray_tracer.h -- the path of a radar beam's axis through spherical layers of air.
//
// Units     Meters; heights are above mean sea level; the arc is along the sphere at sea level.
// Model     A ray over the sphere of stormcellar/grid/beam_geometry.h, bent by Bouguer's law: n r
//           cos(elevation) is the same everywhere along the ray.
// Range     The optical path. The radar measures time and multiplies it by the speed of light in
//           vacuum, so its range is the integral of n along the ray. The optical path is longer
//           than the geometric path: by 56 m at 230 km and 75 m at 460 km, at 0.5 degrees in the
//           exponential reference atmosphere. RangeKind::geometric uses the geometric path, as
//           textbooks do.
// Method    Runge-Kutta of order 4 for the height, the sine of the elevation and the arc. Steps are
//           at most 2 km and end at each border between layers and at each turning point. Hermite
//           cubics interpolate between the ends of steps.
// Ends      The ray ends at the farthest range asked for, or where it meets the floor.
// Bounded   After 20,000 steps, steps no longer end exactly at borders and turning points.
// Threads   A TracedRay is immutable, so any thread may use it.
// Errors    None: results are NaN where the ray does not go.
// Accuracy  Enforced by tests/grid/ray_tracer_test.cpp against quadrature of Bouguer's law in
//           113-bit floats. Height and arc: 1 mm for ranges of -1 to 470 km, elevations of -5 to 60
//           degrees, antennas at -100 to 4,000 m, and levels 10 m and more apart. Trapped in a
//           duct: 10 mm.
#pragma once

#include <vector>

#include "stormcellar/grid/beam_geometry.h"
#include "stormcellar/grid/refractivity.h"

namespace stormcellar::grid {

enum class RangeKind { optical, geometric };

struct RayOptions {
    double earth_radius_m = 0;  // radius of the sphere at sea level
    double antenna_altitude_m = 0;
    double elevation_deg = 0;  // at the antenna, -90 to 90
    // how far the ray also runs behind the antenna, without a floor
    double behind_m = 0;
    double farthest_m = 0;
    double floor_m = -500;  // below all land; if the antenna is lower, its altitude counts instead
    RangeKind range_kind = RangeKind::optical;
};

// A point of the ray, and the ray's direction there.
struct RayNode {
    double range_m = 0;
    double height_m = 0;
    double arc_m = 0;
    double height_rate = 0;  // meters per meter of range
    double arc_rate = 0;
};

class TracedRay {
  public:
    // Integrates the ray. If the elevation is beyond the vertical, or a number is not finite, the
    // ray has no nodes and all results are NaN.
    TracedRay(const RefractivityProfile& profile, const RayOptions& options);

    // at() and over() return NaN where the ray does not go.
    [[nodiscard]] EarthPoint at(double range_m) const noexcept;
    [[nodiscard]] BeamGeometry::BeamPoint over(double arc_m) const noexcept;

    [[nodiscard]] bool meets_floor() const noexcept { return meets_floor_; }
    [[nodiscard]] const std::vector<RayNode>& nodes() const noexcept { return nodes_; }

  private:
    std::vector<RayNode> nodes_;  // the range rises, the arc never falls
    bool meets_floor_ = false;
};

}  // namespace stormcellar::grid
