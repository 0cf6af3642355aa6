// stormcellar/level2/selection.h -- names the moments and cuts of a volume to decode.
//
// The decoder returns the selected parts as it would return them from the whole file; record_plan.h
// states one exception.
//
// Threads   Plain data.
// Errors    None.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "stormcellar/level2/volume.h"

namespace stormcellar::level2 {

struct Selection {
    std::vector<Moment> moments;         // empty: all
    std::vector<int> elevation_numbers;  // cuts of the VCP, from 1; empty: all

    // Returns true for a chosen moment, and for a moment from which a chosen moment is derived.
    [[nodiscard]] bool wants(Moment moment) const {
        return moments.empty() || std::ranges::any_of(moments, [&](Moment chosen) {
                   return chosen == moment || measured_moment(chosen) == moment ||
                          uses_all_moments(chosen);
               });
    }
    [[nodiscard]] bool wants_cut(int elevation_number) const {
        return elevation_numbers.empty() ||
               std::find(elevation_numbers.begin(), elevation_numbers.end(), elevation_number) !=
                   elevation_numbers.end();
    }
    [[nodiscard]] bool all_cuts() const { return elevation_numbers.empty(); }
};

}  // namespace stormcellar::level2
