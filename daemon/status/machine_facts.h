// daemon/status/machine_facts.h -- what the status says of a machine that brings partials of
// mosaics (daemon/partials/partials_keeper.h).
//
// Threads   Plain data.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "stormcellar/base/utc_time.h"

namespace stormcellar::daemon {

struct MachineFacts {
    std::string name = {};  // printable, as all texts here
    std::string directory = {};
    std::optional<UtcTime> newest = {};   // middle of the newest volume that it brought
    std::optional<UtcTime> arrived = {};  // when it last brought something
    std::uint64_t taken = 0;              // partials that are in the cache since the start
    std::uint64_t refused = 0;            // files that are no partial of a mosaic, or damaged
    std::uint64_t replaced = 0;           // partials of others that its own took the place of
    bool is_late = false;
    std::string why = {};           // it is late; empty: it is not
    std::string last_problem = {};  // with its directory or a file; empty: there was none
    bool operator==(const MachineFacts&) const = default;
};

}  // namespace stormcellar::daemon
