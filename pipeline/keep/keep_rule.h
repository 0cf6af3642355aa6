// pipeline/keep/keep_rule.h -- which grids of a volume that stand in the cache give way to another.
//
// Inside the pipeline room only.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "stormcellar/cache/grid_file.h"
#include "stormcellar/cache/store.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::pipeline {

// How the note of a grid of a volume that still grows begins.
inline constexpr std::string_view living_note = "living: ";

// Why the grid at the path must stay: it is whole and the new one is not, its file is newer, or its
// volume has ended and that of the new one still grows. A living grid always gives way to one of a
// volume that has ended. None when it is to be replaced, as one that is damaged, missing or was
// made otherwise always is.
[[nodiscard]] std::optional<std::string> reason_to_keep(const std::filesystem::path& path,
                                                        const cache::GridDescription& made);

// A radar begins no more volumes than that within an hour: the fastest pattern takes three minutes.
inline constexpr std::size_t most_volumes_an_hour = 120;
// Where more stand within half an hour of this grid, the one that was written longest ago goes, so
// that files which claim to be of one station push out little of the others' history. Pinned grids
// and this one stay.
void keep_to_an_hours_volumes(cache::StoreWriter& store, const std::string& domain,
                              level2::Moment moment, UtcTime time);

// Takes away what stands under another time of the same volume: a volume of chunks is named by its
// first radial until the chunk with its header comes. A volume without its header takes nothing
// away, as its beginning may have been deleted since. The source must be named as a chunk
// (stormcellar/level2/chunk_name.h), as that of the grid that goes; pinned grids stay. A grid that
// cannot be read or removed stays too.
void remove_other_times(cache::StoreWriter& store, const std::string& domain, level2::Moment moment,
                        const level2::Volume& volume, const std::string& source_file);

}  // namespace stormcellar::pipeline
