// retrieve/cyclone/nelder_mead.h -- finds a maximum in the plane by the simplex of Nelder and Mead.
//
// Source    Nelder and Mead (1965), with their factors: reflection 1, expansion 2, contraction and
//           shrinkage 1/2.
// Units     Meters.
// Threads   Pure.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "stormcellar/grid/site_frame.h"

namespace stormcellar::retrieve {

struct PlaneMaximum {
    grid::PlanePoint place;
    double value = 0;
};

// Climbs from a triangle of side `step_m` at `start` until the triangle is smaller than `least_m`,
// but takes at most 100 steps. `value` maps a PlanePoint to a number; -infinity is allowed.
template <class Value>
[[nodiscard]] PlaneMaximum climb(grid::PlanePoint start, double step_m, double least_m,
                                 const Value& value) {
    using grid::PlanePoint;
    const auto vertex = [&](PlanePoint place) { return PlaneMaximum{place, value(place)}; };
    const auto mix = [](PlanePoint from, PlanePoint to, double part) {
        return PlanePoint{from.x_m + part * (to.x_m - from.x_m),
                          from.y_m + part * (to.y_m - from.y_m)};
    };
    std::array<PlaneMaximum, 3> corners{vertex(start), vertex({start.x_m + step_m, start.y_m}),
                                        vertex({start.x_m, start.y_m + step_m})};
    const auto sort = [&] {
        std::ranges::sort(corners, std::ranges::greater{}, &PlaneMaximum::value);
    };
    sort();
    for (int step = 0; step < 100; ++step) {
        auto& [best, middle, worst] = corners;
        if (std::hypot(best.place.x_m - worst.place.x_m, best.place.y_m - worst.place.y_m) <
            least_m)
            break;
        const PlanePoint edge = mix(best.place, middle.place, 0.5);
        const PlaneMaximum reflected = vertex(mix(worst.place, edge, 2));
        if (reflected.value > best.value) {
            const PlaneMaximum expanded = vertex(mix(worst.place, edge, 3));
            worst = expanded.value > reflected.value ? expanded : reflected;
        } else if (reflected.value > middle.value) {
            worst = reflected;
        } else {
            const bool is_outside = reflected.value > worst.value;
            const PlaneMaximum contracted = vertex(mix(worst.place, edge, is_outside ? 1.5 : 0.5));
            if (contracted.value > std::max(worst.value, reflected.value)) {
                worst = contracted;
            } else {
                middle = vertex(mix(middle.place, best.place, 0.5));
                worst = vertex(mix(worst.place, best.place, 0.5));
            }
        }
        sort();
    }
    return corners.front();
}

}  // namespace stormcellar::retrieve
