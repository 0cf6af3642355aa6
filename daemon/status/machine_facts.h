// daemon/status/machine_facts.h -- the status of a machine that brings partials of mosaics
// (daemon/partials/partials_keeper.h).
//
// Threads   Plain data.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "stormcellar/base/utc_time.h"

namespace stormcellar::daemon {

struct MachineFacts {
    std::string name = {};  // printable, like all texts here
    std::string directory = {};
    std::optional<UtcTime> newest = {};   // middle of the newest volume that the machine brought
    std::optional<UtcTime> arrived = {};  // when it last brought something
    // Partials of the machine put into the cache since the start.
    std::uint64_t taken = 0;
    // Files of the machine that are damaged or not a partial of a mosaic.
    std::uint64_t refused = 0;
    // Partials of other machines that partials of the machine replaced.
    std::uint64_t replaced = 0;
    bool is_late = false;
    std::string why = {};           // why the machine is late; empty: it is not late
    std::string last_problem = {};  // names the machine's directory or a file; empty: none
    bool operator==(const MachineFacts&) const = default;
};

}  // namespace stormcellar::daemon
