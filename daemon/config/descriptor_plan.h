// daemon/config/descriptor_plan.h -- divides the file descriptors of the process among its parts.
//
// Databases and growing volumes take as many descriptors as there are files that ask for them.
// Their limits are fixed at the start, so that the watcher, the cache, the sockets, the status and
// the workers always have some left.
//
// Threads   Pure: may be called from any thread.
#pragma once

#include <cstddef>
#include <cstdint>

namespace stormcellar::daemon {

struct DescriptorPlan {
    std::size_t databases = 0;  // open at the same time; three descriptors each
    // Limit of the growing files, again of the volumes in chunks, and again of the last volumes of
    // sites; one descriptor each.
    std::size_t growing = 0;
    // Minimum that is left for everything else.
    std::size_t reserved = 0;

    // Divides `limit` descriptors. With 1,024 or more, the feed of all sites fits without
    // reductions.
    [[nodiscard]] static DescriptorPlan of(std::uint64_t limit);
    // Divides the present limit of the process.
    [[nodiscard]] static DescriptorPlan of_this_process();
};

}  // namespace stormcellar::daemon
