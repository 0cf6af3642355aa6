// daemon/queue/pending.h -- how many files are still to be ingested. Thread contract: plain data.
#pragma once

#include <cstddef>

namespace stormcellar::daemon {

struct Pending {
    std::size_t waiting = 0, running = 0, growing = 0;
    std::size_t retrying = 0;  // failed, and wait to be tried again; not among those waiting
    bool operator==(const Pending&) const = default;
};

}  // namespace stormcellar::daemon
