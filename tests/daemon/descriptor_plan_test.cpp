#include "daemon/config/descriptor_plan.h"

#include <gtest/gtest.h>

#include "stormcellar/base/station_table.h"

namespace stormcellar::daemon {
namespace {

TEST(DescriptorPlan, NobodyHasAllOfThem) {
    for (const std::uint64_t limit : {64U, 100U, 256U, 1024U, 4096U, 16'384U, 1U << 20U}) {
        const DescriptorPlan plan = DescriptorPlan::of(limit);
        EXPECT_GE(plan.reserved, limit / 4) << limit;
        EXPECT_LE(3 * plan.databases + 3 * plan.growing + plan.reserved, limit) << limit;
        EXPECT_GE(plan.databases, 4U) << limit;
        EXPECT_GE(plan.growing, 4U) << limit;
    }
}

TEST(DescriptorPlan, TheUnitsLimitServesEveryStation) {
    const DescriptorPlan plan = DescriptorPlan::of(4096);
    EXPECT_GT(plan.databases, all_stations().size() + 64);
    EXPECT_EQ(plan.growing, 448U);
}

}  // namespace
}  // namespace stormcellar::daemon
