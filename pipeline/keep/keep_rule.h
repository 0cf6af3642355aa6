// pipeline/keep/keep_rule.h -- decides which existing grids in the cache a new grid replaces. Used
// only inside the pipeline room.
//
// Threads   Functions without state.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "stormcellar/base/result.h"
#include "stormcellar/cache/grid_file.h"
#include "stormcellar/cache/store.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::pipeline {

// The start of the note in a grid of a volume that is still growing.
inline constexpr std::string_view living_note = "living: ";

// A new grid, and facts about the files of its volume.
struct Candidate {
    const cache::GridDescription& description;
    const grid::BrickView& view;
    bool has_rival = false;  // another file of this volume exists
};

// Returns why the grid at the path must stay; none if the new grid replaces it. It stays if it is
// of a complete volume and the new one is not, or if its volume has ended and the new one's is
// still growing. If another file of the volume exists, it also stays if its volume has the later
// end, or the same end and comes first in an order of the cells. The rule depends on volumes only,
// so that machines with the same files keep the same grid, whichever file came last. A living grid
// is always replaced by a grid of a volume that has ended. A grid that is damaged, missing or made
// in another way is always replaced. Errors: exhausted, if there is no descriptor to open it.
[[nodiscard]] Result<std::optional<std::string>> reason_to_keep(const std::filesystem::path& path,
                                                                const Candidate& made);

// The most volumes that a radar begins within an hour; the fastest pattern takes three minutes.
inline constexpr std::size_t most_volumes_an_hour = 120;
// Returns true if the store has that many within half an hour of the time.
[[nodiscard]] bool has_an_hours_volumes(const cache::StoreReader& store, const std::string& domain,
                                        level2::Moment moment, UtcTime time);
// If there are more grids within half an hour of this one, removes the grid that was written
// longest ago, so that files that claim one station displace little of the history of others.
// Pinned grids and this one stay.
void keep_to_an_hours_volumes(cache::StoreWriter& store, const std::string& domain,
                              level2::Moment moment, UtcTime time);

// Removes grids of the same volume under another time. A volume of chunks is named by its first
// radial until the chunk with its header comes. A radar makes one volume at a time, so a partial
// grid whose radials are within this volume belongs to it. A volume without its header removes
// nothing, since its beginning may have been deleted; nor does a volume whose source does not have
// the name of a chunk (stormcellar/level2/chunk_name.h). Pinned grids, and grids that cannot be
// read or removed, stay.
void remove_other_times(cache::StoreWriter& store, const std::string& domain, level2::Moment moment,
                        const level2::Volume& volume, const std::string& source_file);

}  // namespace stormcellar::pipeline
