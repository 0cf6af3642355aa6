// cli/grid/volume_source.h -- loads a Level II file for the commands that grid it.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "cli/grid/grid_request.h"
#include "stormcellar/base/result.h"
#include "stormcellar/grid/grid.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::cli {

struct SourceVolume {
    level2::Volume volume;
    grid::SitePosition site;
    bool partial = false;
    std::vector<std::string> notes;  // what readers of the result should know
    // What the radar reported to be wrong, as grids store it: "KTLX: standby, ...".
    std::vector<std::string> radar_troubles = {};
    double read_s = 0, decode_s = 0;
};

// Chooses cuts of a volume by its pattern; empty: all. The volume has no sweeps yet.
using ChooseCuts = std::function<std::vector<int>(const level2::Volume&)>;

// Returns the first volume of the file that holds one of the requested moments, with these alone.
// Errors name the file: those of reading and decoding, and of apply_site(); not_found if the
// position of the radar is not known. With `choose_cuts` only the sweeps of these cuts are decoded,
// and all sweeps where that gives none with a moment.
[[nodiscard]] Result<SourceVolume> load_volume(const std::string& file, const GridRequest& request,
                                               const ChooseCuts& choose_cuts = {});
// The same for the bytes of a file that is in memory; `file` is its name.
[[nodiscard]] Result<SourceVolume> decode_volume(std::span<const std::byte> bytes,
                                                 const std::string& file,
                                                 const GridRequest& request,
                                                 const ChooseCuts& choose_cuts = {});

}  // namespace stormcellar::cli
