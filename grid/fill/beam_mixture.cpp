#include "grid/fill/beam_mixture.h"

#include "grid/sweep/sweep_mixture.h"

namespace stormcellar::grid {

Mixture mixture_over(const PolarSweep& sweep, const Method& method, float beam_width_deg,
                     float azimuth_deg, ArcPlace place, const Footprint* footprint) {
    if (footprint != nullptr) {
        const Mixture inside = gates_inside(sweep, *footprint, place);
        if (inside.weight() > 0) return inside;
    }
    switch (method.interpolation) {
        case Interpolation::eight_point:
            return four_gates(sweep, azimuth_deg, place);
        case Interpolation::beam_weighted:
            return gates_by_pattern(sweep, azimuth_deg, place, beam_width_deg);
        case Interpolation::nearest:
        case Interpolation::linear:
            break;
    }
    return nearest_gate(sweep, azimuth_deg, place);
}

BeamMixture beam_over(const PolarSweep& sweep, const Method& method, float azimuth_deg,
                      ArcPlace place) {
    const int position =
        method.radial_elevations ? sweep.radial_at(azimuth_deg) : AzimuthTable::none;
    const BeamHeights heights = sweep.heights_at(position, place);
    const BeamHeights seen = sweep.beam().without_lost_edges(place, heights);
    BeamMixture beam;
    beam.rise_m_per_deg = sweep.beam().rise_m_per_deg(heights);
    beam.height_m = seen.center_m;
    beam.lower_edge_m = seen.lower_m;
    beam.upper_edge_m = seen.upper_m;
    return beam;
}

}  // namespace stormcellar::grid
