#include "pipeline/keep/instance_lock.h"

#include <filesystem>

#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/testing/temporary_directory.h"

namespace stormcellar::pipeline {
namespace {

TEST(InstanceLock, ASecondDaemonIsToldWhoHasIt) {
    const testing::TemporaryDirectory state;
    {
        const Result<InstanceLock> first = InstanceLock::acquire(state.path());
        ASSERT_TRUE(first) << first.error().message;
        const Result<InstanceLock> second = InstanceLock::acquire(state.path());
        ASSERT_FALSE(second);
        EXPECT_EQ(second.error().code, ErrorCode::busy);
        EXPECT_NE(second.error().message.find(fmt::format("(process {})", ::getpid())),
                  std::string::npos)
            << second.error().message;
    }
    EXPECT_TRUE(InstanceLock::acquire(state.path())) << "the first lock was released";
}

TEST(InstanceLock, NeverFollowsALink) {
    const testing::TemporaryDirectory state, elsewhere;
    fs::create_symlink(elsewhere / "victim", state / "stormcellard.lock");
    EXPECT_FALSE(InstanceLock::acquire(state.path()));
    EXPECT_FALSE(fs::exists(elsewhere / "victim"));
}

TEST(InstanceLock, AMissingDirectoryIsAnError) {
    const testing::TemporaryDirectory state;
    EXPECT_FALSE(InstanceLock::acquire(state / "none"));
}

}  // namespace
}  // namespace stormcellar::pipeline
