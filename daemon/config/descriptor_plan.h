// daemon/config/descriptor_plan.h -- how the file descriptors of the process are shared out.
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
    // This many growing files, this many volumes in chunks, and this many last volumes of sites;
    // one descriptor each.
    std::size_t growing = 0;
    // At least this many are left for everything else.
    std::size_t reserved = 0;

    // Shares out `limit` descriptors. With 1,024 or more, the feed of all sites fits without cuts.
    [[nodiscard]] static DescriptorPlan of(std::uint64_t limit);
    // Shares out the limit that the process has now.
    [[nodiscard]] static DescriptorPlan of_this_process();
};

}  // namespace stormcellar::daemon
