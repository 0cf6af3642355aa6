// fetch/pull/grid_list.h -- reads a data server's list of grids, the answer of /api/v1/grids.
//
// Threads   Pure functions.
// Errors    corrupt if the text is not such a list. A grid with an invalid name is left out.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "fetch/pull/pull_config.h"
#include "stormcellar/base/result.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/cache/grid_name.h"

namespace stormcellar::pull {

// A server lists only its newest grids, at most this many.
inline constexpr std::size_t most_listed = 10'000;
// Limit of the size of a list.
inline constexpr std::uint64_t most_list_bytes = std::uint64_t{4} << 20;

[[nodiscard]] std::string list_url(const PullSource& source, UtcTime from);
[[nodiscard]] std::string file_url(const PullSource& source, const cache::GridName& grid);

// Returns the partials (grids of one site on the cells of a domain) of the source's domains and
// stations, newest first, each once, and at most `most_listed`. Leaves out partials that are older
// than `from` or in the future.
[[nodiscard]] Result<std::vector<cache::GridName>> parse_grid_list(std::span<const std::byte> text,
                                                                   const PullSource& source,
                                                                   UtcTime from, UtcTime now);

}  // namespace stormcellar::pull
