// web/doors/thredds/nearest_time.h -- finds the file whose time is nearest to a given time.
//
// Threads   A pure function.
#pragma once

#include <iterator>

#include "stormcellar/base/utc_time.h"

namespace stormcellar::web {

// Returns the entry that is nearest to `time`, in a map by time. If two are equally near, returns
// the earlier one. If the map is empty, returns its end. Takes one search and one step, because a
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
