// cli/accuracy/held_out.h -- `stormcellar accuracy` over time: the error of each way of making a
// grid for an instant, measured on volumes, or repeated cuts, that were held out
// (grid/judge/held_out.h).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "cli/grid/grid_mosaic.h"
#include "cli/grid/grid_request.h"
#include "grid/judge/held_out.h"
#include "stormcellar/base/result.h"
#include "stormcellar/level2/volume.h"
#include "synth/scene.h"

namespace stormcellar::cli {

// One volume of a sequence, and its name.
struct TimedVolume {
    level2::Volume volume;
    grid::SitePosition site;
    std::string name;
};

// Returns volumes of one site in order of time. Errors: bad_argument if there are fewer than three.
[[nodiscard]] Result<std::vector<TimedVolume>> sequence_of(MosaicSources sources);
// Returns the repeated cuts (SAILS, MRLE) of the file's lowest elevation, each as a volume of its
// own. Errors: not_found if there are fewer than three.
[[nodiscard]] Result<std::vector<TimedVolume>> load_repeats(const std::string& file,
                                                            const GridRequest& request);
// Returns three volumes of a simulated scene.
[[nodiscard]] Result<std::vector<TimedVolume>> observe_sequence(const synth::Scene& scene);

struct HeldOutRow {
    std::string name;                  // of the volume that was held out
    double before_s = 0, after_s = 0;  // from the middles of its neighbors to its own
    grid::HeldOut held_out;
};

// Returns one row for each volume that has neighbors.
[[nodiscard]] Result<std::vector<HeldOutRow>> score_sequence(
    const std::vector<TimedVolume>& sequence, const GridRequest& request);

[[nodiscard]] std::string format_held_out(const std::vector<HeldOutRow>& rows, bool markdown);
[[nodiscard]] nlohmann::ordered_json held_out_json(const std::vector<HeldOutRow>& rows);

}  // namespace stormcellar::cli
