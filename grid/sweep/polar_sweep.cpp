#include "grid/sweep/polar_sweep.h"

#include <algorithm>

namespace stormcellar::grid {
namespace {

std::vector<float> azimuths_of(const level2::Sweep& sweep, const ChosenSweep& chosen) {
    std::vector<float> azimuths_deg;
    for (const std::uint32_t radial : chosen.radials)
        azimuths_deg.push_back(normal_azimuth(sweep.radials[radial].azimuth_deg).value_or(0.0F));
    return azimuths_deg;
}

AzimuthTable azimuth_table(const level2::Sweep& sweep, const ChosenSweep& chosen) {
    const std::vector<float> azimuths_deg = azimuths_of(sweep, chosen);
    std::vector<float> sorted = azimuths_deg;
    std::sort(sorted.begin(), sorted.end());
    return {azimuths_deg, azimuth_spacing_deg(sorted, sweep.azimuth_spacing_deg)};
}

}  // namespace

PolarSweep::PolarSweep(const level2::Sweep& sweep, const ChosenSweep& chosen, const BeamModel& beam,
                       const PolarSweepOptions& options)
    : gates_(sweep, chosen, beam, options),
      beam_(beam, chosen.elevation_deg, options.half_beam_deg, options.table_size,
            gates_.first_table()),
      azimuths_(azimuth_table(sweep, chosen)) {}

// Decides for a whole tile. Looks first at the gates at the nearest and the farthest arc of the
// tile, and then at the blocks between these gates in every radial that passes over the tile.
std::optional<CellStatus> PolarSweep::uniform_status(const PolarBounds& bounds) const {
    return gates_.uniform_status(bounds.least_arc_m, bounds.greatest_arc_m, [&](const auto& visit) {
        azimuths_.visit_between(bounds.from_deg, bounds.to_deg, visit);
    });
}

}  // namespace stormcellar::grid
