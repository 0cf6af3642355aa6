// daemon/config/descriptor_plan.h -- divides the file descriptors of the process among its parts.
//
// Each open database and each growing volume takes descriptors. The plan limits the number of
// databases and of growing volumes, so that the watcher, the cache, the sockets, the status and the
// workers always have descriptors left.
//
// Threads   Pure: may be called from any thread.
#pragma once

#include <cstddef>
#include <cstdint>

namespace stormcellar::daemon {

struct DescriptorPlan {
    std::size_t databases = 0;  // limit on open databases, which take three descriptors each
    // Limit on growing files, which take one descriptor each. The limit applies twice: to volumes
    // in chunks, and to the last volumes of sites.
    std::size_t growing = 0;
    // The least number of descriptors that are left for everything else.
    std::size_t reserved = 0;

    // Divides `limit` descriptors. A limit of 1,024 is enough for the feed of all sites.
    [[nodiscard]] static DescriptorPlan of(std::uint64_t limit);
    // Divides the limit that the process has now, or 1,024 descriptors if the limit is unknown.
    [[nodiscard]] static DescriptorPlan of_this_process();
};

}  // namespace stormcellar::daemon
