// stormcellar/grid/beam_model.h -- the rungs of the beam: flat earth, 4/3 earth, a ray traced
// through a profile.
//
// Units   metres and degrees; heights above mean sea level. Sphere:
// stormcellar/grid/beam_geometry.h. Range   as the radar gives it. The traced beam takes it for the
// optical path (stormcellar/grid/ray_tracer.h),
//         the two others for the path itself, as their formulas are meant.
// Cost    path() of a traced beam integrates it once (some 70 us; 0.2 ms with 300 levels);
//         everything asked of a path after that costs tens of nanoseconds.
// Accuracy (enforced by tests/grid/beam_model_test.cpp) flat earth: 1e-9 m of its formula; 4/3
// earth:
//         BeamGeometry's bits; traced: stormcellar/grid/ray_tracer.h; over() undoes at() to 1 mm.
// Threads both classes are immutable and cheap to copy; use one from many threads.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>

#include "stormcellar/grid/beam_geometry.h"
#include "stormcellar/grid/chosen.h"
#include "stormcellar/grid/ray_tracer.h"
#include "stormcellar/grid/refractivity.h"

namespace stormcellar::grid {

enum class BeamKind { flat_earth, four_thirds, traced };
using ChosenBeam = Chosen<BeamKind::four_thirds, BeamKind::flat_earth>;

// The axis of the beam at one elevation.
class BeamPath {
  public:
    // Arc and height of a gate. NaN where the path does not go.
    [[nodiscard]] EarthPoint at(double range_m) const noexcept;
    // Range and height over an arc. NaN where the path never passes.
    [[nodiscard]] BeamGeometry::BeamPoint over(double arc_m) const noexcept;

  private:
    friend class BeamModel;
    ChosenBeam kind_;
    double elevation_deg_ = 0;
    double cosine_ = 1, sine_ = 0;  // flat earth
    double altitude_m_ = 0;
    BeamGeometry four_thirds_{0, 0};
    std::shared_ptr<const TracedRay> ray_;
};

class BeamModel {
  public:
    // A traced path goes from here behind the antenna to there ahead of it, unless it meets the
    // ground (RayOptions::floor_m) first: 600 km, that arcs of 470 km are reached up to 35 degrees.
    static constexpr double behind_m = 1000;
    static constexpr double farthest_m = 600e3;

    // arc = r cos e, height = altitude + r sin e.
    [[nodiscard]] static BeamModel flat_earth(double antenna_altitude_m);
    // BeamGeometry, bit for bit.
    [[nodiscard]] static BeamModel four_thirds(double site_latitude_deg, double antenna_altitude_m);
    [[nodiscard]] static BeamModel traced(double site_latitude_deg, double antenna_altitude_m,
                                          RefractivityProfile profile,
                                          RangeKind range_kind = RangeKind::optical);

    [[nodiscard]] BeamPath path(double elevation_deg) const;
    // Closed, or iterated until the gate is within 1 mm of the point. NaN where no beam reaches it,
    // or, in and below ducts (where several may), when none is found in 100 steps.
    [[nodiscard]] AntennaPoint inverse(EarthPoint point) const;

    [[nodiscard]] BeamKind kind() const noexcept { return kind_; }
    // For provenance: "flat earth", "4/3 earth", "traced, exponential N0 313 H 7350 m".
    [[nodiscard]] std::string name() const;

  private:
    BeamModel(BeamKind kind, double site_latitude_deg, double antenna_altitude_m);
    [[nodiscard]] TracedRay ray(double elevation_deg, double farthest_m) const;
    [[nodiscard]] AntennaPoint traced_inverse(EarthPoint point) const;

    ChosenBeam kind_;
    double radius_m_;  // the Gaussian radius
    double altitude_m_;
    BeamGeometry four_thirds_;
    std::optional<RefractivityProfile> profile_;
    RangeKind range_kind_ = RangeKind::optical;
};

// How far apart two models put the beams of some elevations, where either puts them within the
// limits. Infinite where only one has a place there at all, as when a duct bends the other away.
// Arcs and ranges are taken every 500 m, one step around the limits included. What lies between
// exceeds the result by less than 0.1 m (enforced, down to levels 50 m apart, without ducts);
// tables with that step that are linear between hold no larger differences.
struct BeamLimits {
    double arc_m = 470e3;  // arcs from 0 to this
    double range_m = 470e3;
    double floor_m = 0;  // heights between these
    double ceiling_m = 20e3;
};
struct BeamDifference {
    double height_m = 0;  // over the same arc
    double range_m = 0;   // over the same arc
    double gate_m = 0;    // of the same gate: hypot of the differences of arc and height
};
[[nodiscard]] BeamDifference greatest_difference(const BeamModel& a, const BeamModel& b,
                                                 std::span<const double> elevations_deg,
                                                 const BeamLimits& limits);

}  // namespace stormcellar::grid
