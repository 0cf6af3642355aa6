// web/data/storms/storm_areas.h -- chooses the areas and the grids from which storms are found.
//
// An area is a station or a domain of the cache. By default, the areas are all domains that have
// recent grids. If there are none, the areas are all stations that have recent grids. A grid is
// recent if it is at most `storm_recent` older than the instant. The instant is the given time, or
// by default the time of the newest grid in the cache, so that a cache of old volumes has storms,
// too.
//
// Threads   Pure functions over the lists of grids. They open no grid.
// Errors    See storm_areas().
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "web/data/grids/grids.h"

namespace stormcellar::web {

inline constexpr std::chrono::minutes storm_recent{30};
// Storms are followed through the grids of this time before the newest grid.
inline constexpr std::chrono::minutes storm_history{60};
// Limits of one request.
inline constexpr std::size_t most_storm_areas = 32, most_storm_grids = 24;

struct StormQuery {
    std::optional<std::string> area = {};
    std::optional<UtcTime> at = {};
    level2::Moment moment = level2::Moment::ref;
};

struct StormArea {
    std::string name;
    // Times of its grids in ascending order, at most most_storm_grids. Empty if no grid is recent.
    std::vector<UtcTime> times;
    std::uint64_t changes = 0;  // Grids::changes_of() when the times were read
};

// Returns the areas in the order of their names. Errors: not_found if the named area has no grids
// of the moment; bad_argument if more than most_storm_areas have recent grids and no area is named.
[[nodiscard]] Result<std::vector<StormArea>> storm_areas(const Grids& grids,
                                                         const StormQuery& query);

}  // namespace stormcellar::web
