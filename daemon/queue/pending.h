// daemon/queue/pending.h -- counts the files that must still be ingested.
#pragma once

#include <cstddef>

namespace stormcellar::daemon {

struct Pending {
    std::size_t waiting = 0, running = 0, growing = 0;
    std::size_t retrying = 0;  // failed and wait for another attempt; not counted as waiting
    bool operator==(const Pending&) const = default;
};

}  // namespace stormcellar::daemon
