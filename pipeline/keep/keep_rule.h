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

#include "stormcellar/base/result.h"
#include "stormcellar/cache/grid_file.h"
#include "stormcellar/cache/store.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::pipeline {

// The start of the note in a grid of a volume that is still growing.
inline constexpr std::string_view living_note = "living: ";

// A grid that was made, and what is known of the files of its volume.
struct Candidate {
    const cache::GridDescription& description;
    const grid::BrickView& view;
    bool has_rival = false;  // there is another file of this volume
};

// Returns why the grid at the path must stay: it is whole and the new one is not, or its volume has
// ended and that of the new one is still growing. If another file of the volume is there, the grid
// also stays if its volume has the later end, or the same end and comes first by an order of the
// cells. All of this depends on volumes alone, so that machines which have the same files keep the
// same grid, whichever file came last. A living grid is always replaced by one of a volume that has
// ended. None: it is to be replaced. That is always so if it is damaged, missing or made in another
// way. Errors: exhausted, if there is no descriptor to look at it with.
[[nodiscard]] Result<std::optional<std::string>> reason_to_keep(const std::filesystem::path& path,
                                                                const Candidate& made);

// A radar begins at most this many volumes within an hour: the fastest pattern takes three minutes.
inline constexpr std::size_t most_volumes_an_hour = 120;
// Returns true if the store has as many within half an hour of the time.
[[nodiscard]] bool has_an_hours_volumes(const cache::StoreReader& store, const std::string& domain,
                                        level2::Moment moment, UtcTime time);
// If there are more grids within half an hour of this one, the one that was written longest ago is
// removed, so that files which claim one station displace little of the history of others. Pinned
// grids and this one stay.
void keep_to_an_hours_volumes(cache::StoreWriter& store, const std::string& domain,
                              level2::Moment moment, UtcTime time);

// Removes grids of the same volume under another time: a volume of chunks is named by its first
// radial until the chunk with its header comes. A radar makes one volume at a time, so a partial
// grid whose radials lie within this volume is of it. A volume without its header removes nothing,
// since its beginning may have been deleted; nor does one whose source does not have the name of a
// chunk (stormcellar/level2/chunk_name.h). Pinned grids, and grids that cannot be read or removed,
// stay.
void remove_other_times(cache::StoreWriter& store, const std::string& domain, level2::Moment moment,
                        const level2::Volume& volume, const std::string& source_file);

}  // namespace stormcellar::pipeline
