#include "daemon/config/descriptor_plan.h"

#include <algorithm>

#include <sys/resource.h>

namespace stormcellar::daemon {
namespace {

constexpr std::uint64_t most_reserved = 256;   // connections to the status take up to 96 of these
constexpr std::uint64_t most_databases = 288;  // the station table has about 210 stations
constexpr std::uint64_t most_growing_files = 448;  // two for each station
constexpr std::uint64_t least = 4;

}  // namespace

DescriptorPlan DescriptorPlan::of(std::uint64_t limit) {
    const std::uint64_t reserved = std::min(most_reserved, limit / 4);
    const std::uint64_t left = limit - reserved;
    DescriptorPlan plan;
    plan.databases = std::clamp(left * 2 / 5 / 3, least, most_databases);
    plan.growing = std::clamp(left / 5, least, most_growing_files);
    const std::uint64_t given = 3 * plan.databases + 3 * plan.growing;
    plan.reserved = limit - std::min(limit, given);
    return plan;
}

DescriptorPlan DescriptorPlan::of_this_process() {
    rlimit limit{};
    if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return of(1024);
    return of(std::min<std::uint64_t>(limit.rlim_cur, 1U << 20U));
}

}  // namespace stormcellar::daemon
