// cli/accuracy/truth_errors.h -- how far grids are from the truth of a simulated scene
// (synth/compare_with_truth.h), as a table and as JSON.
//
// Thread contract: pure functions.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "stormcellar/accuracy/quantity.h"
#include "synth/compare_with_truth.h"

namespace stormcellar::cli {

[[nodiscard]] std::string format_truth(const std::vector<synth::TruthRow>& rows,
                                       accuracy::ValueUnit unit, bool markdown);
[[nodiscard]] nlohmann::ordered_json truth_json(const std::vector<synth::TruthRow>& rows);

}  // namespace stormcellar::cli
