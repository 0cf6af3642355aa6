// daemon/config/descriptor_plan.h -- divides the file descriptors of the process among its parts.
//
// Each open database and each growing volume takes descriptors. The plan limits the numbers of
// both, so that the watcher, the cache, the sockets, the status and the workers always have
// descriptors left.
//
// Threads   Pure: may be called from any thread.
#pragma once

#include <cstddef>
#include <cstdint>

namespace stormcellar::daemon {

struct DescriptorPlan {
    std::size_t databases = 0;  // open at the same time; three descriptors each
    // Limit on growing files. The same limit applies separately to volumes in chunks and to the
    // last volumes of sites. Each file or volume takes one descriptor.
    std::size_t growing = 0;
    // Minimum that is left for all other parts.
    std::size_t reserved = 0;

    // Divides `limit` descriptors. With 1,024 or more, the feed of all sites fits.
    [[nodiscard]] static DescriptorPlan of(std::uint64_t limit);
    // Divides the present limit of the process, or 1,024 descriptors if the limit is unknown.
    [[nodiscard]] static DescriptorPlan of_this_process();
};

}  // namespace stormcellar::daemon
