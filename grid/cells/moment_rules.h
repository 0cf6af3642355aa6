// grid/cells/moment_rules.h -- how grids treat the values of each moment.
//
// The table has one row for each moment. It extends the table of stormcellar/level2/moment.h.
//
// Threads   Constants.
#pragma once

#include <string_view>

#include "stormcellar/accuracy/quantity.h"
#include "stormcellar/grid/brick_view.h"
#include "stormcellar/level2/moment.h"

namespace stormcellar::grid {

struct MomentRules {
    level2::Moment moment = level2::Moment::ref;
    // The coding of stored values. The steps between codes are no coarser than those of the
    // radar's own codes.
    Quantization quantization = {};
    accuracy::ValueUnit value_unit = accuracy::ValueUnit::ratio;  // unit of errors
    // True if, in a mean with echo, a gate without echo counts as its detection limit.
    bool has_detection_limit = false;
    // The reason why values of different sites are not mixed; empty if they may be mixed.
    std::string_view why_sites_stay_apart = {};
    // True if a mosaic nevertheless takes the largest value of all sites. For shear this is right,
    // because rotation exists if any site sees it.
    bool takes_largest_of_sites = false;
};

[[nodiscard]] const MomentRules& rules_of(level2::Moment moment);

}  // namespace stormcellar::grid
