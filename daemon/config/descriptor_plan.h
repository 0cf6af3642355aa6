// daemon/config/descriptor_plan.h -- how the process shares out its descriptors.
//
// Databases and growing volumes hold as many descriptors as files claim. The plan limits them at
// the start, so that the watcher, the cache, the sockets, the status and the workers always find
// some. Thread contract: pure functions.
#pragma once

#include <cstddef>
#include <cstdint>

namespace stormcellar::daemon {

struct DescriptorPlan {
    std::size_t databases = 0;  // open at once; each takes three descriptors
    // Growing files, volumes of chunks, and last volumes of sites: this many of each, one
    // descriptor each.
    std::size_t growing = 0;
    // At least this many are left for everything else.
    std::size_t reserved = 0;

    // The plan for this many descriptors in all. 1,024 or more suffice for the feed of all sites.
    [[nodiscard]] static DescriptorPlan of(std::uint64_t limit);
    // The plan for the limit that the process has now.
    [[nodiscard]] static DescriptorPlan of_this_process();
};

}  // namespace stormcellar::daemon
