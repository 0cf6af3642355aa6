// grid/cells/moment_rules.h -- what a grid does with the values of each moment.
//
// One row for each moment adds what grids need to stormcellar/level2/moment.h.
// Threads   Constants.
#pragma once

#include <string_view>

#include "stormcellar/accuracy/quantity.h"
#include "stormcellar/grid/brick_view.h"
#include "stormcellar/level2/moment.h"

namespace stormcellar::grid {

struct MomentRules {
    level2::Moment moment = level2::Moment::ref;
    // The coding of stored values. Steps are no coarser than the radar's own codes.
    Quantization quantization = {};
    accuracy::ValueUnit value_unit = accuracy::ValueUnit::ratio;  // of errors
    // True if a gate without echo enters a mean as the weakest echo that it could have shown.
    bool has_detection_limit = false;
    // Reason why values of different sites are not mixed; empty if they are mixed.
    std::string_view why_sites_stay_apart = {};
};

[[nodiscard]] const MomentRules& rules_of(level2::Moment moment);

}  // namespace stormcellar::grid
