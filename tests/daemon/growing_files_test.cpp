#include "daemon/queue/growing_files.h"

#include <map>

#include <gtest/gtest.h>

#include "tests/daemon/steady_start.h"

namespace stormcellar::daemon {
namespace {

using std::chrono::seconds;

constexpr FileStamp small{1, 100, 5};
constexpr FileStamp large{1, 200, 6};

// A fake disk that knows only sizes and times of files, and a clock that advances by seconds.
class Growing : public ::testing::Test {
  protected:
    // Advances to t0 + `second` and returns the files that are due: "a", or "a!" if finish_as_is is
    // set.
    std::string due_at(int second) {
        std::string text;
        const auto look = [this](const std::filesystem::path& path) -> FileFound {
            const auto found = disk_.find(path);
            if (found == disk_.end()) return {};
            return {Standing::regular, found->second};
        };
        for (const auto& due : files_.poll(t0 + seconds{second}, look)) {
            text += due.path.native() + (due.finish_as_is ? "!" : "");
        }
        return text;
    }

    std::map<std::filesystem::path, FileStamp> disk_;
    GrowingFiles files_{seconds{30}, 3};
};

TEST_F(Growing, AnIncompleteFileIsFinishedWhenItWasQuietLongEnough) {
    disk_["a"] = small;
    files_.add_incomplete("a", small, t0);
    for (int second = 1; second < 30; ++second)
        ASSERT_EQ(due_at(second), "") << second;
    EXPECT_EQ(due_at(30), "a!");
    EXPECT_EQ(due_at(99), "") << "the file is due only once";
    EXPECT_EQ(files_.count(), 0U);
}

TEST_F(Growing, AtTheBoundTheStationThatHasMostGivesWay) {
    EXPECT_TRUE(files_.add_new("x1", small, t0));
    EXPECT_TRUE(files_.add_new("x2", small, t0));
    EXPECT_TRUE(files_.add_incomplete("x3", small, t0));
    EXPECT_FALSE(files_.add_new("x4", small, t0)) << "files of no station fill all places";
    EXPECT_TRUE(files_.add_new("a", small, t0, "KTLX"));
    EXPECT_TRUE(files_.contains("a"));
    EXPECT_EQ(files_.take_displaced(), (std::vector<std::filesystem::path>{"x1"}));
    EXPECT_FALSE(files_.add_new("b", small, t0, "KTLX"))
        << "KTLX would have two files, and two files are of no station";
    EXPECT_EQ(files_.count(), 3U);
    files_.forget("x2");
    EXPECT_TRUE(files_.add_new("b", small, t0, "KTLX"));
    EXPECT_TRUE(files_.take_displaced().empty());
}

TEST_F(Growing, AFollowedFileIsGivenTenTimesAsLong) {
    disk_["a"] = small;
    files_.add_incomplete("a", small, t0, true);
    for (int second = 1; second < 300; ++second)
        ASSERT_EQ(due_at(second), "") << second;
    EXPECT_EQ(due_at(300), "a!");
}

TEST_F(Growing, AnIncompleteFileThatGrowsIsReadAgainWhenItRests) {
    disk_["a"] = small;
    files_.add_incomplete("a", small, t0);
    EXPECT_EQ(due_at(25), "");
    disk_["a"] = large;
    EXPECT_EQ(due_at(26), "") << "the file has just changed";
    EXPECT_EQ(due_at(27), "a");
    // The quiet time starts again when the file is read again.
    files_.add_incomplete("a", large, t0 + seconds{28});
    EXPECT_EQ(due_at(57), "");
    EXPECT_EQ(due_at(58), "a!");
}

TEST_F(Growing, AFileThatChangedWhileItWasReadIsReadAgain) {
    disk_["a"] = large;
    files_.add_incomplete("a", small, t0);
    EXPECT_EQ(due_at(1), "");
    EXPECT_EQ(due_at(2), "a");
}

TEST_F(Growing, ANewFileIsOfferedWhenItRests) {
    disk_["a"] = small;
    files_.add_new("a", small, t0);
    EXPECT_EQ(due_at(1), "a");
}

TEST_F(Growing, ANewFileThatNeverRestsIsOfferedSoon) {
    files_.add_new("a", small, t0);
    for (int second = 1; second < 3; ++second) {
        disk_["a"] = {1, static_cast<std::uint64_t>(second), 0};
        ASSERT_EQ(due_at(second), "") << second;
    }
    disk_["a"] = {1, 3, 0};
    EXPECT_EQ(due_at(3), "a");
}

TEST_F(Growing, AnEmptyNewFileHasTheWholeQuietTime) {
    disk_["a"] = {1, 0, 0};
    files_.add_new("a", {1, 0, 0}, t0);
    EXPECT_EQ(due_at(29), "");
    EXPECT_EQ(due_at(30), "a");
}

// If there are no descriptors left, the file must not be forgotten.
TEST_F(Growing, AFileThatCannotBeLookedAtNowStays) {
    files_.add_incomplete("a", small, t0);
    disk_["a"] = small;
    const auto blind = [](const std::filesystem::path&) {
        return FileFound{Standing::unknown, {}, 0};
    };
    EXPECT_TRUE(files_.poll(t0 + std::chrono::seconds{2}, blind).empty());
    EXPECT_TRUE(files_.contains("a"));
}

TEST_F(Growing, AFileThatVanishesIsForgotten) {
    files_.add_new("a", small, t0);
    EXPECT_EQ(due_at(1), "");
    EXPECT_EQ(files_.count(), 0U);
    EXPECT_FALSE(files_.next_time());
}

// The event of the file's deletion may be lost, and chunks of a volume may wait under the name of
// the file.
TEST_F(Growing, AnIncompleteFileThatVanishesIsDue) {
    files_.add_incomplete("a", small, t0);
    EXPECT_EQ(due_at(1), "a");
    EXPECT_EQ(files_.count(), 0U);
}

TEST_F(Growing, OneThatIsGoneAndStillWaitedForIsAskedForWhenItWasQuiet) {
    files_.add_incomplete("a", {}, t0);
    for (int second = 1; second < 30; ++second)
        ASSERT_EQ(due_at(second), "") << second;
    EXPECT_EQ(due_at(30), "a!");
    files_.add_incomplete("a", {}, t0 + seconds{31});
    disk_["a"] = small;
    EXPECT_EQ(due_at(32), "");
    EXPECT_EQ(due_at(33), "a") << "the file has come back";
}

TEST_F(Growing, StampsAreReadOnceASecond) {
    files_.add_new("a", small, t0);
    EXPECT_EQ(files_.next_time(), t0 + seconds{1});
    int looks = 0;
    const auto look = [&](const std::filesystem::path&) -> FileFound {
        ++looks;
        return {Standing::regular, {1, 0, 0}};
    };
    for (int ms = 0; ms < 5000; ms += 10)
        (void)files_.poll(t0 + std::chrono::milliseconds{ms}, look);
    EXPECT_EQ(looks, 4);
}

TEST_F(Growing, HasABound) {
    EXPECT_TRUE(files_.add_new("a", small, t0));
    EXPECT_TRUE(files_.add_new("b", small, t0));
    EXPECT_TRUE(files_.add_incomplete("c", small, t0));
    EXPECT_FALSE(files_.add_new("d", small, t0));
    EXPECT_FALSE(files_.add_incomplete("d", small, t0));
    EXPECT_TRUE(files_.add_incomplete("a", small, t0)) << "a kept file may become incomplete";
    files_.forget("b");
    EXPECT_TRUE(files_.add_new("d", small, t0));
}

TEST_F(Growing, KnowsWhenAFileWasFoundIncomplete) {
    files_.add_new("a", small, t0);
    files_.add_incomplete("b", small, t0 + seconds{3});
    EXPECT_FALSE(files_.found_incomplete_at("a"));
    EXPECT_EQ(files_.found_incomplete_at("b"), t0 + seconds{3});
    EXPECT_FALSE(files_.found_incomplete_at("c"));
}

}  // namespace
}  // namespace stormcellar::daemon
