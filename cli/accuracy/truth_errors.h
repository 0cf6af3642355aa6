// cli/accuracy/truth_errors.h -- reports how far grids are from the truth of a simulated scene
// (synth/compare_with_truth.h), as a table and as JSON.
//
// The differences come from sampling: the radar did not see all air, and the storm changed during
// the volume. The truth is taken at the center of each cell, at the middle of the volume's time. A
// cell counts if it has a value and the truth there is above -20 dBZ.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "stormcellar/accuracy/quantity.h"
#include "synth/compare_with_truth.h"

namespace stormcellar::cli {

[[nodiscard]] std::string format_truth(const std::vector<synth::TruthRow>& rows,
                                       accuracy::ValueUnit unit, bool markdown);
// Sets the fields count, rms, p95, p99 and max of the row.
void add_errors(const accuracy::ErrorSummary& errors, nlohmann::ordered_json& row);
[[nodiscard]] nlohmann::ordered_json truth_json(const std::vector<synth::TruthRow>& rows);

}  // namespace stormcellar::cli
