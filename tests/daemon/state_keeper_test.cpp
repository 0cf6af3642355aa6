#include "daemon/care/state_keeper.h"

#include <gtest/gtest.h>

#include "tests/daemon/write_file.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::daemon {
namespace {

namespace fs = std::filesystem;

class StateKeeperTest : public ::testing::Test {
  protected:
    testing::TemporaryDirectory root_;
    const fs::path state_ = root_ / "a/state";
    StateKeeper keeper_{state_};
};

TEST_F(StateKeeperTest, MakesWhatIsMissingAndHoldsIt) {
    ASSERT_TRUE(keeper_.hold());
    EXPECT_TRUE(fs::is_directory(state_ / "catalog"));
    EXPECT_FALSE(keeper_.look()) << "nothing is missing";
    const Status other = StateKeeper(state_).hold();
    ASSERT_FALSE(other);
    EXPECT_EQ(other.error().code, ErrorCode::busy);
}

TEST_F(StateKeeperTest, MakesItAgainWithItsLock) {
    ASSERT_TRUE(keeper_.hold());
    for (const char* gone : {"", "catalog", "stormcellard.lock"}) {
        fs::remove_all(state_ / gone);
        const auto made = keeper_.look();
        ASSERT_TRUE(made) << gone;
        ASSERT_TRUE(*made) << gone << (*made).error().message;
        EXPECT_TRUE(fs::is_directory(state_ / "catalog")) << gone;
        EXPECT_FALSE(StateKeeper(state_).hold())
            << gone << ": the keeper must hold the new state directory";
        EXPECT_FALSE(keeper_.look());
    }
}

TEST_F(StateKeeperTest, RemovesWhatAKilledServiceLeft) {
    const fs::path catalog = state_ / "catalog";
    fs::create_directories(catalog);
    write_file(state_ / ".stormcellar-tmp-status", "half");
    write_file(catalog / ".stormcellar-tmp-4242-0", "half");
    write_file(catalog / "drop-directory", "whole");
    ASSERT_TRUE(keeper_.hold());
    EXPECT_FALSE(fs::exists(state_ / ".stormcellar-tmp-status"));
    EXPECT_FALSE(fs::exists(catalog / ".stormcellar-tmp-4242-0"));
    EXPECT_TRUE(fs::exists(catalog / "drop-directory"));
    // A later call must keep temporary files, because this service may be writing such files.
    write_file(catalog / ".stormcellar-tmp-4242-0", "half");
    ASSERT_TRUE(keeper_.hold());
    EXPECT_TRUE(fs::exists(catalog / ".stormcellar-tmp-4242-0"));
}

TEST_F(StateKeeperTest, SaysWhyItCannot) {
    ASSERT_TRUE(keeper_.hold());
    fs::remove_all(root_ / "a");
    write_file(root_ / "a", "in the way");
    const auto refused = keeper_.look();
    ASSERT_TRUE(refused);
    ASSERT_FALSE(*refused);
    EXPECT_NE((*refused).error().message.find("Not a directory"), std::string::npos);
    fs::remove(root_ / "a");
    const auto made = keeper_.look();
    ASSERT_TRUE(made);
    EXPECT_TRUE(*made);
}

}  // namespace
}  // namespace stormcellar::daemon
