// stormcellar/grid/beam_model.h -- the rungs of the beam: a flat earth, a 4/3 earth, and a ray
// traced through a profile of the air.
//
// Units     Meters and degrees; heights are above mean sea level. The sphere is the sphere of
//           stormcellar/grid/beam_geometry.h.
// Range     As the radar reports it. For the traced beam, the range is the optical path
//           (stormcellar/grid/ray_tracer.h); for the two other beams, the length of the path.
// Cost      path() integrates a traced beam once (some 70 us; 0.2 ms with 300 levels). After that,
//           each call of the path costs tens of nanoseconds.
// Threads   Both classes are immutable and cheap to copy; many threads may use one object.
// Errors    None: results are NaN where a path does not go.
// Accuracy  Enforced by tests/grid/beam_model_test.cpp. Flat earth: 1e-9 m of its formula. 4/3
//           earth: the bits of BeamGeometry. Traced: see stormcellar/grid/ray_tracer.h. over()
//           undoes at() to 1 mm.
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
    // Returns the arc and the height of a gate, or NaN where the path does not go.
    [[nodiscard]] EarthPoint at(double range_m) const noexcept;
    // Returns the range and the height over an arc, or NaN where the path never passes over it.
    [[nodiscard]] BeamGeometry::BeamPoint over(double arc_m) const noexcept;

  private:
    friend class BeamModel;
    ChosenBeam kind_;
    double elevation_deg_ = 0;
    double cosine_ = 1, sine_ = 0;  // used by the flat earth
    double altitude_m_ = 0;
    BeamGeometry four_thirds_{0, 0};
    std::shared_ptr<const TracedRay> ray_;
};

class BeamModel {
  public:
    // A traced path runs from behind_m behind the antenna to farthest_m ahead of it, unless it
    // meets the ground first (RayOptions::floor_m). With 600 km, beams of up to 35 degrees reach
    // arcs of 470 km.
    static constexpr double behind_m = 1000;
    static constexpr double farthest_m = 600e3;

    // The formulas are arc = r cos e and height = altitude + r sin e.
    [[nodiscard]] static BeamModel flat_earth(double antenna_altitude_m);
    // Makes a model that equals BeamGeometry, bit for bit.
    [[nodiscard]] static BeamModel four_thirds(double site_latitude_deg, double antenna_altitude_m);
    [[nodiscard]] static BeamModel traced(double site_latitude_deg, double antenna_altitude_m,
                                          RefractivityProfile profile,
                                          RangeKind range_kind = RangeKind::optical);

    [[nodiscard]] BeamPath path(double elevation_deg) const;
    // Returns the gate that sees a point. The flat and the 4/3 earth have a closed form. For a
    // traced beam, the call iterates until the gate is within 1 mm of the point. The result is NaN
    // if no beam reaches the point. In and below ducts, where several beams may reach a point, the
    // result is also NaN if 100 steps find no beam.
    [[nodiscard]] AntennaPoint inverse(EarthPoint point) const;

    [[nodiscard]] BeamKind kind() const noexcept { return kind_; }
    // Returns a name for provenance: "flat earth", "4/3 earth", "traced, exponential N0 313 H 7350
    // m".
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

// greatest_difference() returns the largest difference between two models, over the beams of some
// elevations, at all places within the limits that either model reaches. The difference is infinite
// if only one model reaches some place, for example because a duct bends the beam of the other
// model away.
//
// Arcs and ranges are compared every 500 m, up to one step beyond the limits. Between these points
// the difference exceeds the result by less than 0.1 m (enforced for levels at least 50 m apart,
// without ducts). A table that is linear between the same points differs no more.
struct BeamLimits {
    double arc_m = 470e3;  // the greatest arc
    double range_m = 470e3;
    double floor_m = 0;       // the least height
    double ceiling_m = 20e3;  // the greatest height
};
struct BeamDifference {
    double height_m = 0;  // over the same arc
    double range_m = 0;   // over the same arc
    double gate_m = 0;    // for the same gate: hypot of the differences of arc and height
};
[[nodiscard]] BeamDifference greatest_difference(const BeamModel& a, const BeamModel& b,
                                                 std::span<const double> elevations_deg,
                                                 const BeamLimits& limits);

}  // namespace stormcellar::grid
