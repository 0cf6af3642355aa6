// pipeline/keep/keep_rule.h -- which existing grids in the cache are replaced by another grid. Used
// only inside the pipeline room.
//
// Threads   Functions without state.
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

// The start of the note in a grid of a volume that is still growing.
inline constexpr std::string_view living_note = "living: ";

// Returns why the grid at the path must stay: it is whole and the new one is not, its file is
// newer, or its volume has ended and that of the new one is still growing. A living grid is always
// replaced by one of a volume that has ended. None: it is to be replaced. That is always so if it
// is damaged, missing or made in another way.
[[nodiscard]] std::optional<std::string> reason_to_keep(const std::filesystem::path& path,
                                                        const cache::GridDescription& made);

// A radar begins at most this many volumes within an hour: the fastest pattern takes three minutes.
inline constexpr std::size_t most_volumes_an_hour = 120;
// If there are more grids within half an hour of this one, the one that was written longest ago is
// removed, so that files which claim one station displace little of the history of others. Pinned
// grids and this one stay.
void keep_to_an_hours_volumes(cache::StoreWriter& store, const std::string& domain,
                              level2::Moment moment, UtcTime time);

// Removes grids of the same volume under another time: a volume of chunks is named by its first
// radial until the chunk with its header comes. A volume without its header removes nothing, since
// its beginning may have been deleted. The source must have the name of a chunk
// (stormcellar/level2/chunk_name.h), like that of the grid that is removed. Pinned grids, and grids
// that cannot be read or removed, stay.
void remove_other_times(cache::StoreWriter& store, const std::string& domain, level2::Moment moment,
                        const level2::Volume& volume, const std::string& source_file);

}  // namespace stormcellar::pipeline
