// grid/fill/beam_choice.h -- decides which beams count at a height of a column, for values and for
// details.
//
// Between two adjacent beams both count, and upper_share() gives the share of the upper beam.
// Elsewhere (below the lowest beam, above the highest, beside a lost cut) at most one beam counts,
// which beam_alone() returns; the interpolation beam_weighted adds the neighbors of this beam. A
// beam is any type with `height_m`, `lower_edge_m` and `upper_edge_m`.
//
// Threads   Pure functions.
#pragma once

namespace stormcellar::grid {

// Returns the beam that counts alone at a height. This is the nearer of the beams whose edges
// enclose the height, or the lower beam if two are equally near. Returns null if no beam encloses
// the height, which is then not seen. `below` is the highest beam at or below the height, and
// `above` is the lowest beam above it; either is null if there is no such beam.
template <class Beam>
[[nodiscard]] const Beam* beam_alone(const Beam* below, const Beam* above, float height_m) {
    const bool in_below = below != nullptr && height_m <= below->upper_edge_m;
    const bool in_above = above != nullptr && height_m >= above->lower_edge_m;
    if (in_below && in_above) {
        const bool below_is_nearer = height_m - below->height_m <= above->height_m - height_m;
        return below_is_nearer ? below : above;
    }
    return in_below ? below : in_above ? above : nullptr;
}

// Returns the share, from 0 to 1, of the upper of two adjacent beams; the lower beam has the rest.
// `linear` is the fraction of the way from the lower to the upper beam. With `nearest`, the nearer
// beam has everything.
[[nodiscard]] inline float upper_share(float linear, bool nearest) {
    if (!nearest) return linear;
    return linear > 0.5F ? 1.0F : 0.0F;
}

}  // namespace stormcellar::grid
