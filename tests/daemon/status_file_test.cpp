#include "daemon/status/status_file.h"

#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/status/status.h"
#include "tests/daemon/steady_start.h"
#include "tests/service/fake_notifier.h"
#include "tests/testing/power_cut_file_system.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::daemon {
namespace {

using std::chrono::milliseconds;

class StatusFileTest : public ::testing::Test {
  protected:
    [[nodiscard]] std::string state_on_disk() const {
        std::ifstream file(state_ / "status.json");
        if (!file) return "none";
        return nlohmann::json::parse(file)["state"];
    }
    [[nodiscard]] std::size_t entries() const {
        return static_cast<std::size_t>(
            std::distance(std::filesystem::directory_iterator(state_.path()), {}));
    }

    testing::TemporaryDirectory state_;
    FakeNotifier notifier_;
    StatusBook book_{"/d", "/c"};
    std::function<StatusFile::Texts()> texts_ = [this] {
        return StatusFile::Texts{book_.line({}), book_.json({}, now_utc())};
    };
};

TEST_F(StatusFileTest, IsWrittenAtMostOnceASecondAndOnlyForAChange) {
    StatusFile file(real_file_system(), state_.path(), notifier_);
    file.publish(texts_, t0, false);
    EXPECT_EQ(state_on_disk(), "none") << "nothing has changed";
    file.changed();
    file.publish(texts_, t0, false);
    EXPECT_EQ(state_on_disk(), "starting");
    book_.set_state("running");
    file.changed();
    EXPECT_EQ(file.next_time(), t0 + milliseconds{1000});
    file.publish(texts_, t0 + milliseconds{999}, false);
    EXPECT_EQ(state_on_disk(), "starting");
    file.publish(texts_, t0 + milliseconds{1000}, false);
    EXPECT_EQ(state_on_disk(), "running");
    EXPECT_FALSE(file.next_time());
    book_.set_state("stopped");
    file.publish(texts_, t0 + milliseconds{1001}, true);
    EXPECT_EQ(state_on_disk(), "stopped");
    EXPECT_EQ(entries(), 1U) << "no temporary file is left";
    EXPECT_EQ(notifier_.sent().size(), 3U);
    EXPECT_TRUE(notifier_.sent()[0].starts_with("STATUS=ingested 0"));
}

TEST_F(StatusFileTest, TakesTheLeftoverOfAKilledDaemonAway) {
    std::ofstream(state_ / ".stormcellar-tmp-status") << "half";
    StatusFile file(real_file_system(), state_.path(), notifier_);
    file.publish(texts_, t0, true);
    EXPECT_EQ(state_on_disk(), "starting");
    EXPECT_EQ(entries(), 1U);
}

TEST_F(StatusFileTest, AFullDiskLeavesTheLastWholeDocument) {
    testing::PowerCutFileSystem disk;
    StatusFile file(disk, state_.path(), notifier_);
    file.publish(texts_, t0, true);
    ASSERT_EQ(state_on_disk(), "starting");
    disk.set_space(10);
    book_.set_state("running");
    file.publish(texts_, t0, true);
    EXPECT_EQ(state_on_disk(), "starting");
    EXPECT_EQ(entries(), 1U);
}

// 2026-11-22: after a failed write, the temporary file stayed, and nothing was written until the
// next change.
TEST_F(StatusFileTest, WhatCannotBePutInPlaceIsTakenAwayAndTriedAgain) {
    std::filesystem::create_directory(state_ / "status.json");
    StatusFile file(real_file_system(), state_.path(), notifier_);
    file.publish(texts_, t0, true);
    EXPECT_EQ(entries(), 1U) << "no temporary file is left";
    std::filesystem::remove(state_ / "status.json");
    ASSERT_TRUE(file.next_time());
    file.publish(texts_, *file.next_time(), false);
    EXPECT_EQ(state_on_disk(), "starting");
    EXPECT_FALSE(file.next_time());
}

}  // namespace
}  // namespace stormcellar::daemon
