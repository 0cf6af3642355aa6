// cli/accuracy/held_out_accuracy.h -- `stormcellar accuracy` over time: leaves out a volume or a
// repeated cut, interpolates a grid for its instant by each method, and measures the error of each
// (grid/judge/held_out_sequence.h).
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "cli/grid/grid_mosaic.h"
#include "cli/grid/grid_request.h"
#include "grid/judge/held_out_sequence.h"
#include "stormcellar/base/result.h"
#include "synth/synth_scene.h"

namespace stormcellar::cli {

// Returns the volumes of one site, in order of time. Errors: bad_argument if there are fewer than
// three.
[[nodiscard]] Result<std::vector<grid::TimedVolume>> sequence_of(MosaicSources sources);
// Returns the repeated cuts (SAILS, MRLE) of the file's lowest elevation, each as a volume of its
// own. Errors: not_found if there are fewer than three.
[[nodiscard]] Result<std::vector<grid::TimedVolume>> load_repeats(const std::string& file,
                                                                  const GridRequest& request);
// Returns three volumes of a simulated scene.
[[nodiscard]] Result<std::vector<grid::TimedVolume>> observe_sequence(const synth::Scene& scene);

// Returns one row for each volume that has a volume before and after it.
[[nodiscard]] Result<std::vector<grid::HeldOutRow>> score_sequence(
    const std::vector<grid::TimedVolume>& sequence, const GridRequest& request,
    const std::function<void(std::size_t done, std::size_t total)>& progress);

[[nodiscard]] std::string format_held_out(const std::vector<grid::HeldOutRow>& rows, bool markdown);
[[nodiscard]] nlohmann::ordered_json held_out_json(const std::vector<grid::HeldOutRow>& rows);

}  // namespace stormcellar::cli
