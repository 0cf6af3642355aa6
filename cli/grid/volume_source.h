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

// Returns the first volume of the file that holds one of the requested moments, with these moments
// only. If `choose_cuts` is set, decodes only the sweeps of the chosen cuts, or all sweeps if the
// chosen sweeps hold none of the moments. Errors name the file: those of reading and decoding, and
// of apply_site(); not_found if the position of the radar is unknown.
[[nodiscard]] Result<SourceVolume> load_volume(const std::string& file, const GridRequest& request,
                                               const ChooseCuts& choose_cuts = {});
// Decodes a volume as load_volume() does, from the bytes of a file in memory. `file` is the name of
// this file. If it has several volumes, uses the volume that begins at `start`.
[[nodiscard]] Result<SourceVolume> decode_volume(std::span<const std::byte> bytes,
                                                 const std::string& file,
                                                 const GridRequest& request, UtcTime start,
                                                 const ChooseCuts& choose_cuts = {});

}  // namespace stormcellar::cli
