// Tests that a check of the configuration says as which user it ran.
#include "service/arguments.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace stormcellar {
namespace {

// 2026-11-28: stormcellar-pull did not say as which user it checked, so a check as root, who may
// read everything, found no fault.
TEST(ServiceArguments, TheCheckSaysAsWhom) {
    const std::string as = checked_as("stormcellar-pull", "stormcellar-pull");
    EXPECT_THAT(as, ::testing::StartsWith("checked as the user "));
    if (::geteuid() != 0) return;
    EXPECT_THAT(as, ::testing::EndsWith("sudo -u stormcellar-pull stormcellar-pull ..."));
}

}  // namespace
}  // namespace stormcellar
