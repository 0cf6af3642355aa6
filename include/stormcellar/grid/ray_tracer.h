// stormcellar/grid/ray_tracer.h -- the path of a radar beam's axis through spherical layers of air.
//
// Units   metres; heights above mean sea level; the arc is along the sphere at sea level.
// Model   a ray over a sphere (stormcellar/grid/beam_geometry.h says which), bent as Bouguer's law
// says:
//         n r cos(elevation) is the same all along it.
// Range   OPTICAL path: the radar measures time and turns it into range with the speed of light in
//         vacuum, so its range is the integral of n along the ray. It is longer than the path
//         itself by N: at 0.5 degrees in the exponential reference atmosphere 56 m at 230 km, 75 m
//         at 460 km. RangeKind::geometric counts the path itself, as textbooks do.
// Method  Runge-Kutta of order 4 on height, sine of the elevation and arc, steps of at most 2 km
//         that end at each border between layers and each turning point; Hermite cubics between.
// Ends    where the range is reached, or where the ray meets the floor.
// Accuracy (enforced by tests/grid/ray_tracer_test.cpp against quadrature of Bouguer's law in
// 113-bit
//         floats) height and arc: 1 mm for ranges [-1, 470] km, elevations [-5, 60] deg, antennas
//         at -100 to 4,000 m, levels 10 m and more apart. Trapped in a duct: 10 mm.
// Bounded 20,000 steps, then with layers and turning points no longer met to the centimetre.
// Threads a TracedRay is immutable.
#pragma once

#include <vector>

#include "stormcellar/grid/beam_geometry.h"
#include "stormcellar/grid/refractivity.h"

namespace stormcellar::grid {

enum class RangeKind { optical, geometric };

struct RayOptions {
    double earth_radius_m = 0;  // the sphere's at sea level
    double antenna_altitude_m = 0;
    double elevation_deg = 0;  // at the antenna, -90 to 90
    double behind_m = 0;       // how far the ray also goes on behind the antenna; no floor there
    double farthest_m = 0;
    double floor_m = -500;  // below all land; where the antenna is lower, the antenna's altitude
    RangeKind range_kind = RangeKind::optical;
};

// A point of the ray and which way it goes there.
struct RayNode {
    double range_m = 0;
    double height_m = 0;
    double arc_m = 0;
    double height_rate = 0;  // metres per metre of range
    double arc_rate = 0;
};

class TracedRay {
  public:
    // Without nodes (all is NaN) for an elevation beyond the vertical or numbers that are not
    // finite.
    TracedRay(const RefractivityProfile& profile, const RayOptions& options);

    // Each NaN where the ray does not go.
    [[nodiscard]] EarthPoint at(double range_m) const noexcept;
    [[nodiscard]] BeamGeometry::BeamPoint over(double arc_m) const noexcept;

    [[nodiscard]] bool meets_floor() const noexcept { return meets_floor_; }
    [[nodiscard]] const std::vector<RayNode>& nodes() const noexcept { return nodes_; }

  private:
    std::vector<RayNode> nodes_;  // of rising range and never falling arc
    bool meets_floor_ = false;
};

}  // namespace stormcellar::grid
