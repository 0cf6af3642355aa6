// cli/accuracy/truth_errors.h -- reports how far grids are from the truth of a simulated scene
// (synth/compare_with_truth.h), as a table and as JSON.
//
// The differences are sampling errors: air that the radar did not see, and changes of the storm
// during the volume. The truth is taken at the center of each cell, at the middle of the volume's
// time. A cell counts if it has a value and the truth there is above -20 dBZ.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "stormcellar/accuracy/quantity.h"
#include "synth/compare_with_truth.h"

namespace stormcellar::cli {

[[nodiscard]] std::string format_truth(const std::vector<synth::TruthRow>& rows,
                                       accuracy::ValueUnit unit, bool markdown);
// Sets count, rms, p95, p99 and max.
void add_errors(const accuracy::ErrorSummary& errors, nlohmann::ordered_json& row);
[[nodiscard]] nlohmann::ordered_json truth_json(const std::vector<synth::TruthRow>& rows);

}  // namespace stormcellar::cli
