// grid/cells/moment_rules.h -- how grids treat the values of each moment.
//
// A table here has one row for each moment, and extends the table of stormcellar/level2/moment.h.
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
    // The coding of stored values. Steps are no coarser than the radar's own codes.
    Quantization quantization = {};
    accuracy::ValueUnit value_unit = accuracy::ValueUnit::ratio;  // unit of errors
    // True if no echo enters a mean with the detection limit of its gate.
    bool has_detection_limit = false;
    // The reason why values of different sites are not mixed; empty if they are mixed.
    std::string_view why_sites_stay_apart = {};
};

[[nodiscard]] const MomentRules& rules_of(level2::Moment moment);

}  // namespace stormcellar::grid
