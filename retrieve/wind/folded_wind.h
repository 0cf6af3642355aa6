// retrieve/wind/folded_wind.h -- estimates the wind above the radar by height from velocities that
// may be folded.
//
// A wind (u, v) has the component c = (u sin a + v cos a) cos e along a beam of azimuth a and
// elevation e. Folding does not change exp(i pi velocity / Nyquist), so for each layer and
// candidate wind the fit sums cos(pi (c - velocity) / Nyquist). The best path through the layers
// gives neighboring layers similar winds.
//
// Units     m/s, meters above the antenna. u is toward the east, v toward the north.
// Accuracy  Good enough to choose fold numbers, but no measurement of the wind.
// Threads   Pure functions.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "retrieve/dealias/velocity_sheet.h"

namespace stormcellar::retrieve {

struct FoldedWind {
    static constexpr double layer_m = 400;
    static constexpr std::size_t layers = 40;
    struct Layer {
        double u_mps = 0, v_mps = 0;
        // 1 if all velocities agree with the wind; 0 if they are random or there are none
        double agreement = 0;
    };
    std::array<Layer, layers> by_height;

    // Returns the layer at a height. A height above the top layer or below the antenna gets the
    // nearest layer.
    [[nodiscard]] const Layer& at(double height_m) const;
};

[[nodiscard]] FoldedWind fit_folded_wind(std::span<const VelocitySheet> sheets);

// Returns the height above the antenna of each gate of a sheet, on a sphere of 4/3 of the earth's
// radius.
[[nodiscard]] std::vector<float> gate_heights_m(const VelocitySheet& sheet);

}  // namespace stormcellar::retrieve
