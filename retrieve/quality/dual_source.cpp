#include "retrieve/quality/dual_source.h"

namespace stormcellar::retrieve {

using level2::Moment;

bool has_dual_polarization(const level2::Sweep& sweep) {
    return sweep.find(Moment::rho) != nullptr && sweep.find(Moment::zdr) != nullptr &&
           sweep.find(Moment::phi) != nullptr;
}

std::optional<std::size_t> dual_source(const level2::Volume& volume, std::size_t sweep) {
    const level2::Sweep& of = volume.sweeps[sweep];
    if (has_dual_polarization(of)) return std::nullopt;
    return companion_sweep(volume, sweep, of.mean_elevation_deg(), Moment::rho);
}

}  // namespace stormcellar::retrieve
