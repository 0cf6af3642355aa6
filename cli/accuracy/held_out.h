// cli/accuracy/held_out.h -- `stormcellar accuracy` over time: what each way of making a grid for
// an instant errs by, scored on volumes, or repeated cuts, that were held out
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

// One volume of a sequence, and what it is called.
struct TimedVolume {
    level2::Volume volume;
    grid::SitePosition site;
    std::string name;
};

// Volumes of one site, in order of time. bad_argument when there are less than three.
[[nodiscard]] Result<std::vector<TimedVolume>> sequence_of(MosaicSources sources);
// The repeated cuts (SAILS, MRLE) of the file's lowest elevation, each as a volume of its own.
// not_found when there are less than three.
[[nodiscard]] Result<std::vector<TimedVolume>> load_repeats(const std::string& file,
                                                            const GridRequest& request);
// Three volumes of a simulated scene.
[[nodiscard]] Result<std::vector<TimedVolume>> observe_sequence(const synth::Scene& scene);

struct HeldOutRow {
    std::string name;                  // of what was held out
    double before_s = 0, after_s = 0;  // from the neighbours' middles to its own
    grid::HeldOut held_out;
};

// One row for each volume that has neighbours.
[[nodiscard]] Result<std::vector<HeldOutRow>> score_sequence(
    const std::vector<TimedVolume>& sequence, const GridRequest& request);

[[nodiscard]] std::string format_held_out(const std::vector<HeldOutRow>& rows, bool markdown);
[[nodiscard]] nlohmann::ordered_json held_out_json(const std::vector<HeldOutRow>& rows);

}  // namespace stormcellar::cli
