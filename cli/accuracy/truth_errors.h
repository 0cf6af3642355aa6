// cli/accuracy/truth_errors.h -- how far grids are from the truth of a simulated scene.
//
// That is the sampling error: what the radar did not see, and what the storm did in the meantime.
// The truth is taken at the center of each cell, at the middle of the volume's time. Cells count
// that hold a value where the truth has echo above the weakest shown (-20 dBZ).
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "grid/plan/scene.h"
#include "stormcellar/accuracy/error_statistics.h"
#include "stormcellar/accuracy/quantity.h"
#include "stormcellar/base/result.h"
#include "synth/scene.h"

namespace stormcellar::cli {

struct TruthRow {
    std::string chain;
    accuracy::ErrorSummary error;
    double mean = 0;           // of the signed errors
    double echo_missed = 0;    // share of the seen cells with a truth above 5 dBZ that hold none
    double echo_invented = 0;  // share of the cells above 5 dBZ with a truth below -5 dBZ
};

[[nodiscard]] Result<std::vector<TruthRow>> compare_with_truth(grid::GridScene& scene,
                                                               const synth::Scene& truth,
                                                               std::size_t columns);
[[nodiscard]] std::string format_truth(const std::vector<TruthRow>& rows, accuracy::ValueUnit unit,
                                       bool markdown);
[[nodiscard]] nlohmann::ordered_json truth_json(const std::vector<TruthRow>& rows);

}  // namespace stormcellar::cli
