// cli/accuracy/truth_errors.h -- how far grids are from the truth of a simulated scene.
//
// That is sampling error: what the radar did not see, and what the storm did meanwhile. The truth
// is taken at each cell's centre, in the middle of the volume's time; cells count that hold a value
// where the truth has echo above the weakest shown (-20 dBZ).
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
    double echo_missed = 0;    // share of cells seen whose truth is above 5 dBZ and that hold none
    double echo_invented = 0;  // share of cells above 5 dBZ whose truth is below -5 dBZ
};

[[nodiscard]] Result<std::vector<TruthRow>> compare_with_truth(grid::GridScene& scene,
                                                               const synth::Scene& truth,
                                                               std::size_t columns);
[[nodiscard]] std::string format_truth(const std::vector<TruthRow>& rows, accuracy::ValueUnit unit,
                                       bool markdown);
[[nodiscard]] nlohmann::ordered_json truth_json(const std::vector<TruthRow>& rows);

}  // namespace stormcellar::cli
