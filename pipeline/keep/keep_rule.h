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

// A grid of a volume that is still growing ("living grid") has a note with this start.
inline constexpr std::string_view living_note = "living: ";

// A new grid.
struct Candidate {
    const cache::GridDescription& description;
    const grid::BrickView& view;
    bool has_rival = false;  // another file of this volume exists
};

// Returns the reason why the existing grid at the path must stay; none if the new grid replaces it.
// The first of the following rules that applies decides. A grid that is missing, damaged, or of
// another spec or moment is replaced. A grid of an ended volume wins over a living grid. A grid of
// a complete volume wins over a grid of an incomplete volume. If both grids are of ended volumes
// and another file of the volume exists, the grid with the later end wins; if the ends are equal,
// the grid that comes first in an order of the cells wins. Otherwise the new grid replaces the old
// one. So machines with the same files keep the same grid, in whatever order the files came.
// Errors: exhausted or no_space if a shortage keeps the existing grid from being opened.
[[nodiscard]] Result<std::optional<std::string>> reason_to_keep(const std::filesystem::path& path,
                                                                const Candidate& made);

// The largest number of volumes that may begin within an hour. A radar's fastest pattern takes
// three minutes.
inline constexpr std::size_t most_volumes_an_hour = 120;
// Returns true if the store has at least `most_volumes_an_hour` grids within half an hour of
// `time`.
[[nodiscard]] bool has_an_hours_volumes(const cache::StoreReader& store, const std::string& domain,
                                        level2::Moment moment, UtcTime time);
// If the store has more than `most_volumes_an_hour` grids within half an hour of `time`, removes
// the one among them that was written longest ago. So forged files of one station displace little
// of the history of other stations. Pinned grids, and the grid at `time`, stay.
void keep_to_an_hours_volumes(cache::StoreWriter& store, const std::string& domain,
                              level2::Moment moment, UtcTime time);

// Removes those grids of a volume in chunks whose time is not the time in the volume's header.
// Until the chunk with the header comes, the time of the first radial names the grid. A radar makes
// one volume at a time, so a partial grid whose radials are within this volume is of this volume.
// Does nothing for a volume without a header, whose beginning may have been deleted, or if
// `source_file` is not the name of a chunk (stormcellar/level2/chunk_name.h). Pinned grids, and
// grids that cannot be read or removed, stay.
void remove_other_times(cache::StoreWriter& store, const std::string& domain, level2::Moment moment,
                        const level2::Volume& volume, const std::string& source_file);

}  // namespace stormcellar::pipeline
