// web/doors/thredds/nearest_time.h -- the file whose time is the nearest.
//
// Threads   A pure function.
#pragma once

#include <iterator>

#include "stormcellar/base/utc_time.h"

namespace stormcellar::web {

// Returns the entry of a map by time that is nearest to `time`. Of two equally near entries,
// returns the earlier one; of an empty map, the end. Takes one search and one step, because one
// query may call this 10,000 times.
template <class Times>
[[nodiscard]] auto nearest_time(const Times& times, UtcTime time) {
    const auto behind = times.lower_bound(time);
    if (behind == times.begin()) return behind;
    const auto before = std::prev(behind);
    const bool is_nearer = behind == times.end() || time - before->first <= behind->first - time;
    return is_nearer ? before : behind;
}

}  // namespace stormcellar::web
