// cli/grid/volume_source.h -- a Level II file as the commands that grid it want it.
#pragma once

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
    double read_s = 0, decode_s = 0;
};

// Of one of the request's inputs: the first volume that holds the moment, that moment
// alone. Errors name the file: those of reading and decoding, and of apply_site(); not_found where
// nobody knows where the radar stands.
[[nodiscard]] Result<SourceVolume> load_volume(const std::string& file, const GridRequest& request);

}  // namespace stormcellar::cli
