// daemon/config/descriptor_plan.h -- how the descriptors that the process may have are shared out.
//
// Databases and growing volumes hold as many as files claim. What they may hold is settled at the
// start, so that the watcher, the cache, the sockets, the status and the workers always find some.
// Thread contract: pure functions.
#pragma once

#include <cstddef>
#include <cstdint>

namespace stormcellar::daemon {

struct DescriptorPlan {
    std::size_t databases = 0;  // open at once; three descriptors each
    // Files that grow, volumes of chunks, and sites' last volumes: so many of each, one descriptor
    // each.
    std::size_t growing = 0;
    // What is left for everything else, at least.
    std::size_t reserved = 0;

    // Of so many in all. With 1,024 or more, nothing that the feed of all sites needs is cut short.
    [[nodiscard]] static DescriptorPlan of(std::uint64_t limit);
    // Of the limit that the process has now.
    [[nodiscard]] static DescriptorPlan of_this_process();
};

}  // namespace stormcellar::daemon
