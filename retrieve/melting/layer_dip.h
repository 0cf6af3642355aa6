// retrieve/melting/layer_dip.h -- finds a melting layer in a profile: a dip of the correlation
// coefficient between air of high correlation, with a maximum of reflectivity and ZDR.
//
// Conditions are in stormcellar/retrieve/melting_layer.h.
//
// Units     Meters above the antenna.
// Threads   Plain data and pure functions.
#pragma once

#include <optional>

#include "retrieve/melting/height_profile.h"

namespace stormcellar::retrieve {

struct LayerDip {
    double bottom_m = 0, top_m = 0;
    double beam_m = 0;  // standard deviation of height in the beam
    [[nodiscard]] double center_m() const { return (bottom_m + top_m) / 2; }
};

struct DipSearch {
    std::optional<LayerDip> dip;
    bool is_tall_enough = false;  // somewhere, both sides of a dip could be seen
    // The lowest levels have a dip whose lower side is not seen.
    bool is_open_below = false;
};

[[nodiscard]] DipSearch find_dip(const HeightProfile& profile);

}  // namespace stormcellar::retrieve
