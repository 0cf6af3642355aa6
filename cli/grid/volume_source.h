// cli/grid/volume_source.h -- loads a Level II file for the commands that grid it.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "cli/grid/grid_request.h"
#include "grid/place/source_volume.h"
#include "stormcellar/base/result.h"

namespace stormcellar::cli {

using grid::ChooseCuts;
using grid::SourceVolume;

// Returns the first volume of the file that holds one of the requested moments, with these alone.
// Errors name the file: those of reading and decoding, and of apply_site(); not_found if the
// position of the radar is not known. With `choose_cuts` only the sweeps of these cuts are decoded,
// and all sweeps where that gives none with a moment.
[[nodiscard]] Result<SourceVolume> load_volume(const std::string& file, const GridRequest& request,
                                               const ChooseCuts& choose_cuts = {});
// The same for the bytes of a file that is in memory; `file` is its name. Of several volumes in it,
// the one that begins at `start` is taken.
[[nodiscard]] Result<SourceVolume> decode_volume(std::span<const std::byte> bytes,
                                                 const std::string& file,
                                                 const GridRequest& request, UtcTime start,
                                                 const ChooseCuts& choose_cuts = {});

}  // namespace stormcellar::cli
