// grid/cells/moment_rules.h -- what a grid does with the values of each moment.
//
// This is grid's layer over stormcellar/level2/moment.h: one row a moment.
// Threads: constants.
#pragma once

#include <string_view>

#include "stormcellar/accuracy/quantity.h"
#include "stormcellar/grid/brick_view.h"
#include "stormcellar/level2/moment.h"

namespace stormcellar::grid {

struct MomentRules {
    level2::Moment moment = level2::Moment::ref;
    // How values are stored; steps are no coarser than the radar's own codes.
    Quantization quantization = {};
    accuracy::ValueUnit value_unit = accuracy::ValueUnit::ratio;  // of errors
    std::string_view difference_unit = {};                        // of two values
    // A gate without echo enters a mean as the weakest echo that it could have shown.
    bool has_detection_limit = false;
    // Why values of different sites are not mixed; empty where they are.
    std::string_view why_sites_stay_apart = {};
};

[[nodiscard]] const MomentRules& rules_of(level2::Moment moment);

}  // namespace stormcellar::grid
