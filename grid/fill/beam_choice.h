// grid/fill/beam_choice.h -- which beams make up a height of a column: the rule of values and of
// details alike.
//
// Between two adjacent beams both count, by upper_share(). Elsewhere (below the lowest beam, above
// the highest, beside a lost cut) at most one counts: beam_alone(). A beam is anything with
// `height_m`, `lower_edge_m` and `upper_edge_m`.
//
// Threads: pure functions.
#pragma once

namespace stormcellar::grid {

// The beam that counts alone at a height: the nearer of those within whose edges the height lies;
// of two at the same distance the lower. Null where there is none: the height is not seen. `below`
// is the highest beam that lies at the height or below it, `above` the lowest beam above it; each
// is null where there is none.
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

// How much the upper of two adjacent beams counts where a height lies at the fraction `linear` of
// the way from the lower one to it: as much as that, or where `nearest` the nearer beam alone. The
// lower beam has the rest.
[[nodiscard]] inline float upper_share(float linear, bool nearest) {
    if (!nearest) return linear;
    return linear > 0.5F ? 1.0F : 0.0F;
}

}  // namespace stormcellar::grid
