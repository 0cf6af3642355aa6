#include "daemon/watch/watcher.h"

#include <algorithm>
#include <chrono>
#include <fstream>
#include <map>
#include <memory>
#include <set>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/inotify.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/daemon/write_file.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::daemon {
namespace {

namespace fs = std::filesystem;

// Records the calls as "closed NAME" and so on, with names relative to the drop directory.
class Notes final : public WatchListener {
  public:
    explicit Notes(fs::path drop) : drop_(std::move(drop)) {}
    void file_closed(const fs::path& path, const FileStamp&) override { note("closed", path); }
    void file_created(const fs::path& path, const FileStamp&) override { note("created", path); }
    void file_found(const fs::path& path, const FileStamp&) override { note("found", path); }
    void file_gone(const fs::path& path) override { note("gone", path); }
    [[nodiscard]] bool follows(const fs::path& path) const override {
        return path.filename() == followed;
    }
    void file_grew(const fs::path& path, const FileStamp&) override { note("grew", path); }
    void directory_gone(const fs::path& path, bool deleted) override {
        note(deleted ? "deleted" : "moved", path);
    }
    void directory_unread() override { said.emplace_back("unread"); }
    void entry_left_out(const fs::path& path, std::string_view kind) override {
        note(std::string{kind} + ":", path);
    }
    void events_lost() override { said.emplace_back("lost"); }
    void drop_vanished() override { said.emplace_back("vanished"); }
    void directory_problem(const Error& error) override { problems.push_back(error); }

    [[nodiscard]] bool has(const std::string& line) const {
        return std::find(said.begin(), said.end(), line) != said.end();
    }
    // Returns the files that the watcher reported as closed or found.
    [[nodiscard]] std::set<std::string> taken() const {
        std::set<std::string> names;
        for (const std::string& line : said) {
            if (line.starts_with("closed ")) names.insert(line.substr(7));
            if (line.starts_with("found ")) names.insert(line.substr(6));
        }
        return names;
    }

    std::string followed;
    std::vector<std::string> said;
    std::vector<Error> problems;

  private:
    void note(const std::string& what, const fs::path& path) {
        said.push_back(what + " " + path.lexically_relative(drop_).native());
    }
    fs::path drop_;
};

class RealWatcher : public ::testing::Test {
  protected:
    RealWatcher() {
        Result<std::unique_ptr<EventSource>> events = open_inotify();
        if (!events) throw std::runtime_error(events.error().message);
        events_ = std::move(*events);
        watcher_ = std::make_unique<Watcher>(drop(), *events_, notes_);
    }
    [[nodiscard]] fs::path drop() const { return directory_.path(); }
    // Handles events until none come for a moment.
    void settle() {
        pollfd source{events_->descriptor(), POLLIN, 0};
        while (::poll(&source, 1, 50) > 0)
            watcher_->read_events();
    }

    testing::TemporaryDirectory directory_;
    Notes notes_{directory_.path()};
    std::unique_ptr<EventSource> events_;
    std::unique_ptr<Watcher> watcher_;
};

using Lines = std::vector<std::string>;

TEST_F(RealWatcher, FindsWhatStoodThereBefore) {
    fs::create_directory(drop() / "day");
    write_file(drop() / "day/a", "1");
    ASSERT_TRUE(watcher_->scan());
    EXPECT_EQ(notes_.said, Lines{"found day/a"});
    EXPECT_EQ(watcher_->directory_count(), 2U);
}

// A scan of many files takes seconds, and must not delay new files.
TEST_F(RealWatcher, WhatComesDuringAScanIsSeenBeforeItsEnd) {
    constexpr int count = 1000;
    for (int i = 0; i < count; ++i)
        write_file(drop() / std::to_string(i), "1");
    ASSERT_TRUE(watcher_->scan());  // from now on the directory is watched
    notes_.said.clear();
    int steps = 0;
    watcher_->on_step([&] {
        if (++steps == 1) write_file(drop() / "new", "1");
    });
    ASSERT_TRUE(watcher_->scan());
    EXPECT_GE(steps, 7) << "one step for each 128 entries";
    const auto closed = std::find(notes_.said.begin(), notes_.said.end(), "closed new");
    ASSERT_NE(closed, notes_.said.end());
    EXPECT_GT(notes_.said.end() - closed, count / 2)
        << "the event must come before half of the scan";
}

// 2026-11-25: a tree of 10,000 directories that was renamed again and again took all the time of
// the thread.
TEST_F(RealWatcher, DirectoriesThatComeAndGoTooFastAreLeftToTheNextScan) {
    for (int i = 0; i < 5000; ++i)
        fs::create_directories(drop() / "tree0" / std::to_string(i));
    ASSERT_TRUE(watcher_->scan());
    for (int i = 0; i < 200 && !notes_.has("unread"); ++i) {
        fs::rename(drop() / ("tree" + std::to_string(i)),
                   drop() / ("tree" + std::to_string(i + 1)));
        settle();
    }
    ASSERT_TRUE(notes_.has("unread"));
    ASSERT_TRUE(watcher_->scan());
    EXPECT_EQ(watcher_->directory_count(), 5002U)
        << "the watches of vanished directories are forgotten";
    std::string name;
    for (const auto& entry : fs::directory_iterator(drop()))
        name = entry.path().filename().native();
    write_file(drop() / name / "17/a", "1");
    settle();
    EXPECT_TRUE(notes_.has("closed " + name + "/17/a"));
}

TEST_F(RealWatcher, SeesAFileMadeAndClosed) {
    ASSERT_TRUE(watcher_->scan());
    {
        std::ofstream file(drop() / "a");
        file << "first" << std::flush;
        settle();
        EXPECT_EQ(notes_.said, Lines{"created a"}) << "the file is not closed yet";
    }
    settle();
    EXPECT_EQ(notes_.said, (Lines{"created a", "closed a"}));
    append_to_file(drop() / "a", "more");
    settle();
    EXPECT_EQ(notes_.said, (Lines{"created a", "closed a", "closed a"}));
}

TEST_F(RealWatcher, IgnoresADotFileUntilItIsRenamed) {
    ASSERT_TRUE(watcher_->scan());
    write_file(drop() / ".a", "1");
    write_file(drop() / "b.tmp", "1");
    settle();
    EXPECT_EQ(notes_.said, Lines{});
    fs::rename(drop() / ".a", drop() / "a");
    settle();
    EXPECT_EQ(notes_.said, Lines{"closed a"});
}

TEST_F(RealWatcher, SaysWhatWentAndWhereItWent) {
    write_file(drop() / "a", "1");
    write_file(drop() / "b", "1");
    ASSERT_TRUE(watcher_->scan());
    notes_.said.clear();
    fs::remove(drop() / "a");
    fs::rename(drop() / "b", drop() / "c");
    settle();
    EXPECT_EQ(notes_.said, (Lines{"gone a", "gone b", "closed c"}));
}

TEST_F(RealWatcher, AHardLinkIsCreatedAndNeverClosed) {
    const testing::TemporaryDirectory elsewhere;
    write_file(elsewhere / "a", "1");
    ASSERT_TRUE(watcher_->scan());
    fs::create_hard_link(elsewhere / "a", drop() / "a");
    settle();
    EXPECT_EQ(notes_.said, Lines{"created a"});
}

TEST_F(RealWatcher, NeverReportsLinksFifosAndDirectories) {
    const testing::TemporaryDirectory elsewhere;
    write_file(elsewhere / "a", "1");
    ASSERT_TRUE(watcher_->scan());
    fs::create_symlink(elsewhere / "a", drop() / "link");
    fs::create_directory_symlink(elsewhere.path(), drop() / "linked");
    ASSERT_EQ(::mkfifo((drop() / "fifo").c_str(), 0600), 0);
    fs::create_directory(drop() / "KTLX20220317_000842_V06");
    settle();
    write_file(elsewhere / "b", "1");
    settle();
    const Lines left_out = {"a symbolic link: link", "a symbolic link: linked", "a FIFO: fifo"};
    EXPECT_EQ(notes_.said, left_out);
    EXPECT_EQ(watcher_->directory_count(), 2U) << "the drop directory and the real directory";
    notes_.said.clear();
    ASSERT_TRUE(watcher_->scan());
    EXPECT_TRUE(std::is_permutation(notes_.said.begin(), notes_.said.end(), left_out.begin(),
                                    left_out.end()))
        << "scans report this, too";
}

// Another thread makes and fills directories faster than watches can be set.
TEST_F(RealWatcher, MissesNothingInDirectoriesThatAppear) {
    ASSERT_TRUE(watcher_->scan());
    std::set<std::string> expected;
    for (int day = 0; day < 20; ++day) {
        for (int file = 0; file < 50; ++file)
            expected.insert("d" + std::to_string(day) + "/s/f" + std::to_string(file));
    }
    std::thread writer([&] {
        for (const std::string& name : expected) {
            fs::create_directories((drop() / name).parent_path());
            write_file(drop() / name, "1");
        }
    });
    while (notes_.taken().size() < expected.size()) {
        pollfd source{events_->descriptor(), POLLIN, 0};
        if (::poll(&source, 1, 2000) == 0) break;
        watcher_->read_events();
    }
    writer.join();
    settle();
    EXPECT_EQ(notes_.taken(), expected);
    EXPECT_EQ(watcher_->directory_count(), 41U);
}

TEST_F(RealWatcher, FollowsADirectoryThatIsRenamed) {
    fs::create_directory(drop() / "old");
    ASSERT_TRUE(watcher_->scan());
    fs::rename(drop() / "old", drop() / "new");
    settle();
    notes_.said.clear();
    write_file(drop() / "new/a", "1");
    settle();
    EXPECT_TRUE(notes_.has("closed new/a"));
    EXPECT_EQ(watcher_->directory_count(), 2U);
}

TEST_F(RealWatcher, ForgetsADirectoryThatIsMovedAway) {
    const testing::TemporaryDirectory elsewhere;
    fs::create_directories(drop() / "day/site");
    ASSERT_TRUE(watcher_->scan());
    EXPECT_EQ(watcher_->directory_count(), 3U);
    fs::rename(drop() / "day", elsewhere / "day");
    settle();
    write_file(elsewhere / "day/site/a", "1");
    settle();
    EXPECT_EQ(notes_.said, Lines{"moved day"})
        << "files outside of the drop directory are never reported";
    EXPECT_EQ(watcher_->directory_count(), 1U);
}

TEST_F(RealWatcher, ForgetsADirectoryThatIsDeleted) {
    fs::create_directories(drop() / "day/site");
    ASSERT_TRUE(watcher_->scan());
    fs::remove_all(drop() / "day");
    settle();
    EXPECT_EQ(notes_.said, (Lines{"deleted day/site", "deleted day"}));
    EXPECT_EQ(watcher_->directory_count(), 1U);
}

// The watcher sees each directory when it appears, and must count its depth from the drop
// directory.
TEST_F(RealWatcher, DirectoriesThatAppearAreNoDeeperThanThoseThatAreFound) {
    ASSERT_TRUE(watcher_->scan());
    fs::path path = drop();
    for (int i = 0; i < 40; ++i) {
        path /= "d";
        fs::create_directory(path);
        settle();
    }
    EXPECT_EQ(watcher_->directory_count(), 17U) << "the drop directory and 16 directories below it";
    EXPECT_EQ(notes_.problems.size(), 1U) << "files below that depth are not reported";
}

// 2026-11-28: LDM wrote with umask 027, and the service was not in its group. Only one line in the
// log showed this.
TEST_F(RealWatcher, NamesTheDirectoriesThatItMayNotRead) {
    if (::geteuid() != 0) GTEST_SKIP() << "only root can become another user";
    fs::permissions(drop(), fs::perms{0755});
    fs::create_directory(drop() / "KLOT");
    fs::permissions(drop() / "KLOT", fs::perms{0700});
    const auto scan_as = [&](uid_t user) {
        EXPECT_EQ(::seteuid(user), 0);
        EXPECT_TRUE(watcher_->scan());
        EXPECT_EQ(::seteuid(0), 0);
    };
    scan_as(65534);
    const std::map<std::string, std::string> named{
        {drop() / "KLOT",
         "Permission denied; the service needs a group that may read it (ldm-group.conf)"}};
    EXPECT_EQ(watcher_->unreadable().named, named);
    ASSERT_EQ(notes_.problems.size(), 1U);
    EXPECT_NE(notes_.problems[0].message.find("KLOT: Permission denied; the service needs a group"),
              std::string::npos);
    scan_as(0);
    EXPECT_EQ(watcher_->unreadable().count(), 0U) << "the permissions were corrected";
}

TEST(Unreadable, SaysWhatTheUnitHides) {
    EXPECT_TRUE(is_below_home("/home/ldm/var"));
    EXPECT_TRUE(is_below_home("/root/x"));
    EXPECT_FALSE(is_below_home("/homes/ldm"));
    EXPECT_NE(remedy_for("/home/ldm/x", ErrorCode::not_found).find("ldm-in-home.conf"),
              std::string::npos);
    EXPECT_EQ(remedy_for("/data/x", ErrorCode::not_found), "");
}

TEST_F(RealWatcher, SaysWhenTheDropDirectoryVanishesAndTakesItAgain) {
    ASSERT_TRUE(watcher_->scan());
    fs::remove_all(drop());
    settle();
    EXPECT_TRUE(notes_.has("vanished"));
    EXPECT_FALSE(watcher_->scan());
    fs::create_directory(drop());
    write_file(drop() / "a", "1");
    ASSERT_TRUE(watcher_->scan());
    EXPECT_TRUE(notes_.has("found a"));
    write_file(drop() / "b", "1");
    settle();
    EXPECT_TRUE(notes_.has("closed b"));
}

TEST_F(RealWatcher, AMissingDropDirectoryIsAnError) {
    Watcher watcher(drop() / "none", *events_, notes_);
    EXPECT_FALSE(watcher.scan());
}

// Makes more events than the kernel queues. The kernel drops some, the watcher reports that, and a
// scan finds all files.
TEST_F(RealWatcher, ASecondScanFindsWhatAnOverflowHid) {
    std::size_t queue = 0;
    std::ifstream("/proc/sys/fs/inotify/max_queued_events") >> queue;
    if (queue == 0 || queue > 50'000) GTEST_SKIP() << "the event queue is too long to overflow";
    ASSERT_TRUE(watcher_->scan());
    write_file(drop() / "a", "1");
    write_file(drop() / "b", "1");
    // The kernel merges equal events in a row, so two events alternate.
    for (std::size_t i = 0; i <= queue; ++i)
        append_to_file(drop() / (i % 2 == 0 ? "a" : "b"), "");
    write_file(drop() / "late", "1");
    settle();
    EXPECT_TRUE(notes_.has("lost"));
    EXPECT_FALSE(notes_.taken().contains("late"));
    ASSERT_TRUE(watcher_->scan());
    EXPECT_TRUE(notes_.taken().contains("late"));
}

// Returns events that tests make, and limits the watches.
class FakeEvents final : public EventSource {
  public:
    [[nodiscard]] int descriptor() const override { return -1; }
    Result<int> watch(const fs::path& directory) override {
        if (static_cast<int>(watched.size()) >= most) {
            return fail(ErrorCode::no_space, "{}: no inotify watches left", directory.native());
        }
        watched.push_back(directory);
        return static_cast<int>(watched.size());
    }
    void unwatch(int) override {}
    std::vector<DirectoryEvent> read() override { return std::exchange(waiting, {}); }
    std::optional<std::string> silence(const fs::path& directory) override {
        if (directory.filename() != silent) return std::nullopt;
        return directory.native() + ": lies on NFS";
    }

    int most = 1000;
    std::string silent = "none";
    std::vector<fs::path> watched;
    std::vector<DirectoryEvent> waiting;
};

// The drop directory may be a link, because the watcher watches "DIR/.".
TEST(Inotify, NamesADirectoryAsItIsCalled) {
    const testing::TemporaryDirectory directory;
    const auto events = open_inotify();
    ASSERT_TRUE(events);
    fs::create_directory_symlink(directory.path(), directory / "link");
    EXPECT_TRUE((*events)->watch(directory / "link/."));
    EXPECT_FALSE((*events)->watch(directory / "link"));
    const auto none = (*events)->watch(directory / "none/.");
    ASSERT_FALSE(none);
    EXPECT_TRUE(none.error().message.starts_with((directory / "none").native() + ": "));
}

class ForcedWatcher : public ::testing::Test {
  protected:
    testing::TemporaryDirectory directory_;
    FakeEvents events_;
    Notes notes_{directory_.path()};
    Watcher watcher_{directory_.path(), events_, notes_};
};

TEST_F(ForcedWatcher, SaysWhenTheKernelDroppedEvents) {
    ASSERT_TRUE(watcher_.scan());
    write_file(directory_ / "a", "1");
    events_.waiting = {{-1, IN_Q_OVERFLOW, ""}, {1, IN_CLOSE_WRITE, "a"}};
    watcher_.read_events();
    EXPECT_EQ(notes_.said, (Lines{"lost", "closed a"}));
}

TEST_F(ForcedWatcher, ReachingTheLimitOfWatchesIsSaidAndTheScanStillFindsEverything) {
    for (const char* name : {"a", "b", "c"}) {
        fs::create_directory(directory_ / name);
        write_file(directory_ / name / "file", "1");
    }
    events_.most = 2;
    ASSERT_TRUE(watcher_.scan());
    EXPECT_TRUE(watcher_.is_blind());
    ASSERT_EQ(notes_.problems.size(), 1U) << "the first directory is reported";
    EXPECT_EQ(notes_.problems[0].code, ErrorCode::no_space);
    EXPECT_EQ(notes_.taken(), (std::set<std::string>{"a/file", "b/file", "c/file"}));
    events_.watched.clear();
    ASSERT_TRUE(watcher_.scan());
    EXPECT_EQ(notes_.problems.size(), 1U) << "the lack of watches is reported once";
    events_.watched.clear();
    events_.most = 1000;
    ASSERT_TRUE(watcher_.scan());
    EXPECT_FALSE(watcher_.is_blind()) << "somebody raised the limit";
    events_.watched.clear();
    events_.most = 2;
    ASSERT_TRUE(watcher_.scan());
    EXPECT_EQ(notes_.problems.size(), 2U) << "the lack of watches is reported again";
}

TEST_F(ForcedWatcher, SilentDirectoriesAreWatchedAllTheSameAndSaidOnce) {
    fs::create_directories(directory_ / "day/shared");
    events_.silent = "shared";
    ASSERT_TRUE(watcher_.scan());
    EXPECT_TRUE(watcher_.is_blind());
    EXPECT_EQ(watcher_.directory_count(), 3U) << "writes of this machine give events";
    ASSERT_TRUE(watcher_.scan());
    ASSERT_EQ(notes_.problems.size(), 1U);
    EXPECT_EQ(notes_.problems[0].code, ErrorCode::unsupported);
    fs::remove(directory_ / "day/shared");
    ASSERT_TRUE(watcher_.scan());
    EXPECT_FALSE(watcher_.is_blind());
}

TEST_F(ForcedWatcher, EventsOfAWatchThatIsGoneAreLeftAlone) {
    ASSERT_TRUE(watcher_.scan());
    write_file(directory_ / "a", "1");
    events_.waiting = {{99, IN_CLOSE_WRITE, "a"}, {1, IN_IGNORED, ""}, {1, IN_CLOSE_WRITE, "a"}};
    watcher_.read_events();
    EXPECT_EQ(notes_.said, Lines{});
    EXPECT_EQ(watcher_.directory_count(), 0U);
}

TEST_F(ForcedWatcher, WritesAreToldOfFilesThatAreFollowedAndOfNoOthers) {
    notes_.followed = "a";
    ASSERT_TRUE(watcher_.scan());
    write_file(directory_ / "a", "1");
    write_file(directory_ / "b", "1");
    events_.waiting = {{1, IN_MODIFY, "a"}, {1, IN_MODIFY, "b"}, {1, IN_MODIFY, "gone"}};
    watcher_.read_events();
    EXPECT_EQ(notes_.said, Lines{"grew a"});
}

// The file of an event may have been deleted long before the event is read (scour).
TEST_F(ForcedWatcher, AFileThatIsGoneWhenItsEventIsReadIsNotReported) {
    ASSERT_TRUE(watcher_.scan());
    events_.waiting = {{1, IN_CLOSE_WRITE, "a"}, {1, IN_CREATE | IN_ISDIR, "d"}};
    watcher_.read_events();
    EXPECT_EQ(notes_.said, Lines{});
    EXPECT_TRUE(notes_.problems.empty());
}

}  // namespace
}  // namespace stormcellar::daemon
