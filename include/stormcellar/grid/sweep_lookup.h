// stormcellar/grid/sweep_lookup.h -- one sweep as the radar saw it: finds the gate at a place.
//
// A place belongs to the radial whose azimuth is nearest. If neighboring radials are more than one
// and a half spacings apart, each covers half a spacing, and the gap between was not seen. Along
// the radial, a place belongs to the gate whose center is nearest, by the 4/3-earth beam at the
// median elevation of the sweep's radials. Radials measured more than half a beam off the median
// are left out, as in grids. Nothing is mixed or quantized: the result is the value of one gate.
//
// Units     Meters and degrees; values are in the unit of the moment. Heights are above mean sea
//           level. Places are azimuth and arc from the antenna (stormcellar/grid/site_frame.h).
// Threads   Immutable; any thread may use it.
// Errors    See find().
// Accuracy  Enforced by tests/grid/sweep_lookup_test.cpp: equal to the gates, value for value,
//           except for places within 0.2 m of the border of two gates or 1e-4 degrees of the border
//           of two radials.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/grid/grid.h"
#include "stormcellar/grid/site_frame.h"
#include "stormcellar/grid/sweep_choice.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::grid {

// Selects a sweep of a volume: the sweep with `number`, if that is given. Otherwise the sweep whose
// fixed angle is nearest to the elevation is selected, at most `farthest_deg` away, or the lowest
// sweep if no elevation is given. If several sweeps have this angle (SAILS, split cuts),
// choose_sweeps() with the time `nearest_to` selects one of them.
struct SweepWish {
    static constexpr double farthest_deg = 1;
    std::optional<double> elevation_deg{};
    std::optional<std::size_t> number{};  // index in Volume::sweeps
    std::optional<UtcTime> nearest_to{};
};

struct SweepFacts {
    std::size_t number = 0;      // index in Volume::sweeps
    int cut = 0;                 // number of the VCP's cut, from 1
    double elevation_deg = 0;    // the median of the radials used
    double fixed_angle_deg = 0;  // the VCP's angle if it is plausible, else `elevation_deg`
    std::size_t radial_count = 0;
    double azimuth_spacing_deg = 0;
    double gate_spacing_m = 0;  // the smallest, if the radials differ
    double last_gate_m = 0;     // slant range of the far end of the last gate
    double greatest_arc_m = 0;  // the arc at that range, at most the lookup's limit
    float nyquist_mps = 0;      // of the first radial used; 0: unknown
    UtcTime start, end;         // first and last time of a radial; the epoch: unknown
};

// Contents of one gate.
struct GateValue {
    CellStatus status = CellStatus::not_seen;
    float value = 0;  // if the status is value
};

// Position of a gate, and time of its measurement.
struct GatePosition {
    std::uint32_t radial = 0;  // index in Sweep::radials
    std::int32_t gate = 0;
    double azimuth_deg = 0;    // of the radial
    double elevation_deg = 0;  // of the radial, as measured
    double range_m = 0;        // slant range of the center of the gate
    double height_m = 0;       // of the beam's axis at the gate, at the elevation of the sweep
    UtcTime time;              // of the radial
};

class SweepLookup {
  public:
    // Finds the sweep and prepares it. The object shares ownership of the volume. Errors: not_found
    // if no sweep holds the moment, the numbered sweep does not hold it, or no sweep is near the
    // elevation. In the last two cases, the message lists the sweeps that hold the moment.
    [[nodiscard]] static Result<SweepLookup> find(std::shared_ptr<const level2::Volume> volume,
                                                  const SitePosition& site, level2::Moment moment,
                                                  double half_beam_deg, const SweepWish& wish);
    SweepLookup(SweepLookup&&) noexcept;
    SweepLookup& operator=(SweepLookup&&) noexcept;
    ~SweepLookup();

    [[nodiscard]] const SweepFacts& facts() const;
    [[nodiscard]] const SitePosition& site() const;
    [[nodiscard]] level2::Moment moment() const;
    // Returns the gate at a place. The arc must be at least 0, and the azimuth within [0, 360].
    [[nodiscard]] GateValue at(PolarPoint place) const;
    // Returns the gate at a place, or none if no radial saw the place or the place is beyond the
    // gates.
    [[nodiscard]] std::optional<GatePosition> position(PolarPoint place) const;

  private:
    struct Prepared;
    explicit SweepLookup(std::unique_ptr<const Prepared> prepared);
    std::unique_ptr<const Prepared> prepared_;
};

// Returns the fixed angle of one sweep for each elevation at which the moment was measured, lowest
// first. SweepWish::elevation_deg finds these sweeps.
[[nodiscard]] std::vector<double> elevations_deg(const level2::Volume& volume,
                                                 level2::Moment moment, double half_beam_deg);

}  // namespace stormcellar::grid
