#include "grid/plan/cell_circle.h"

#include <algorithm>
#include <cmath>

#include "grid/sweep/mixture.h"

namespace stormcellar::grid {
namespace {

double period_of(const level2::Volume& volume, const ChosenSweep& chosen, level2::Moment moment) {
    const float nyquist_mps =
        chosen.radials.empty()
            ? 0
            : volume.sweeps[chosen.sweep_index].radials[chosen.radials.front()].nyquist_mps;
    return 2 * static_cast<double>(half_period_of(moment, nyquist_mps));
}

double around(double difference, double period) {
    return period > 0 ? std::remainder(difference, period) : difference;
}

}  // namespace

CellCircles::CellCircles(const level2::Volume& volume, const std::vector<ChosenSweep>& chosen,
                         const SitePosition& site, const GridSpec& spec, level2::Moment moment)
    : levels_m_(spec.levels_m) {
    if (!is_circular(blending_of(moment))) return;
    const BeamModel beam = BeamModel::four_thirds(site.latitude_deg, site.altitude_m);
    for (const ChosenSweep& sweep : chosen)
        sweeps_.push_back({beam.path(sweep.elevation_deg), period_of(volume, sweep, moment), 0});
}

void CellCircles::move_to(double arc_m) {
    for (Sweep& sweep : sweeps_)
        sweep.height_m = sweep.path.over(arc_m).height_m;
}

double CellCircles::difference(float a, float b, std::size_t level) const {
    const double difference = static_cast<double>(a) - static_cast<double>(b);
    if (sweeps_.empty()) return difference;
    const auto above = std::find_if(sweeps_.begin(), sweeps_.end(), [&](const Sweep& sweep) {
        return std::isgreaterequal(sweep.height_m, levels_m_[level]);
    });
    const Sweep& upper = above == sweeps_.end() ? sweeps_.back() : *above;
    const Sweep& lower = above == sweeps_.begin() ? upper : *(above - 1);
    const double one = around(difference, upper.period);
    const double other = around(difference, lower.period);
    return std::abs(one) > std::abs(other) ? one : other;
}

}  // namespace stormcellar::grid
