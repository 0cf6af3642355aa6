// cli/volume_source.h -- a Level II file as the commands that grid it want it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/result.h"
#include "grid/grid.h"
#include "level2/volume.h"

namespace stormcellar::cli {

struct SourceVolume {
    level2::Volume volume;
    grid::SitePosition site;
    bool partial = false;
    std::vector<std::string> notes;  // what readers of the result should know
    double read_s = 0, decode_s = 0;
};

// Of a file, or of a directory of chunks: the first volume that holds the moment, that moment
// alone. Errors name the file: those of reading and decoding; not_found where nobody knows where
// the radar stands.
[[nodiscard]] Result<SourceVolume> load_volume(const std::filesystem::path& path,
                                               level2::Moment moment, int threads);

}  // namespace stormcellar::cli
