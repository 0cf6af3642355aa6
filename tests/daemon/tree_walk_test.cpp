#include "daemon/watch/tree_walk.h"

#include <set>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/daemon/write_file.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::daemon {
namespace {

namespace fs = std::filesystem;

struct Seen {
    std::set<std::string> files, directories, problems, others;
};

Result<Seen> walked(const fs::path& root, int depth = 0) {
    Seen seen;
    const Status status =
        walk(root,
             {[&](const fs::path& path) { seen.directories.insert(path.lexically_relative(root)); },
              [&](const fs::path& path, const FileStamp&) {
                  seen.files.insert(path.lexically_relative(root));
              },
              [&](const fs::path&, const Error& problem) { seen.problems.insert(problem.message); },
              [&](const fs::path& path, mode_t mode) {
                  EXPECT_FALSE(S_ISREG(mode) || S_ISDIR(mode));
                  seen.others.insert(path.lexically_relative(root));
              }},
             depth);
    if (!status) return pass_on(status);
    return seen;
}

TEST(TreeWalk, FindsRegularFilesAtAnyDepth) {
    const testing::TemporaryDirectory directory;
    fs::create_directories(directory / "20220317/KTLX");
    write_file(directory / "a", "1");
    write_file(directory / "20220317/KTLX/b\nc", "1");
    const Result<Seen> seen = walked(directory.path());
    ASSERT_TRUE(seen);
    EXPECT_EQ(seen->files, (std::set<std::string>{"a", "20220317/KTLX/b\nc"}));
    EXPECT_EQ(seen->directories, (std::set<std::string>{".", "20220317", "20220317/KTLX"}));
    EXPECT_TRUE(seen->problems.empty());
}

TEST(TreeWalk, LeavesOutLinksFifosAndTemporaryNames) {
    const testing::TemporaryDirectory directory, outside;
    write_file(outside / "secret", "1");
    fs::create_symlink(outside / "secret", directory / "link");
    fs::create_directory_symlink(outside.path(), directory / "linked");
    ASSERT_EQ(::mkfifo((directory / "fifo").c_str(), 0600), 0);
    write_file(directory / ".hidden", "1");
    fs::create_directory(directory / ".unpacking");
    write_file(directory / ".unpacking/x", "1");
    const Result<Seen> seen = walked(directory.path());
    ASSERT_TRUE(seen);
    EXPECT_TRUE(seen->files.empty());
    EXPECT_EQ(seen->directories, std::set<std::string>{"."});
    EXPECT_EQ(seen->others, (std::set<std::string>{"fifo", "link", "linked"}));
}

// The watcher walks a new directory deep in the tree on its own, but the depth still counts from
// the drop directory.
TEST(TreeWalk, DepthCountsFromWhereItIsSaidTo) {
    const testing::TemporaryDirectory directory;
    fs::create_directories(directory / "a/b");
    write_file(directory / "a/file", "1");
    const Result<Seen> seen = walked(directory.path(), max_walk_depth - 1);
    ASSERT_TRUE(seen);
    EXPECT_EQ(seen->files, std::set<std::string>{"a/file"});
    EXPECT_EQ(seen->directories, (std::set<std::string>{".", "a"}));
    EXPECT_EQ(seen->problems.size(), 1U);
    const Result<Seen> too_deep = walked(directory.path(), max_walk_depth + 1);
    ASSERT_TRUE(too_deep);
    EXPECT_TRUE(too_deep->directories.empty());
    EXPECT_EQ(too_deep->problems.size(), 1U);
}

TEST(TreeWalk, PathsThatNoCallTakesAreLeftOut) {
    const testing::TemporaryDirectory directory;
    fs::path path = directory.path();
    while (path.native().size() < 750)
        path /= std::string(250, 'd');
    fs::create_directories(path);
    const int at = ::open(path.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC);
    const std::string name(255, 'f');
    for (int i = 0; i < 2; ++i) {
        ASSERT_EQ(::mkdirat(at, name.c_str(), 0755), i == 0 ? 0 : -1);
        ASSERT_EQ(::mkdirat(at, std::string(254, 'f').c_str(), 0755), i == 0 ? 0 : -1);
    }
    ::close(at);
    write_file(path / "fits", "1");
    const Result<Seen> seen = walked(directory.path());
    ASSERT_TRUE(seen);
    EXPECT_EQ(seen->files.size(), 1U);
    const bool too_long = path.native().size() + 255 >= most_path_bytes;
    EXPECT_EQ(seen->problems.size(), too_long ? 1U : 0U) << "the directory is reported once";
}

TEST(TreeWalk, OnlyItsOwnRootMayBeALink) {
    const testing::TemporaryDirectory directory;
    fs::create_directory(directory / "real");
    write_file(directory / "real/a", "1");
    fs::create_directory_symlink(directory / "real", directory / "link");
    const Result<Seen> seen = walked(directory / "link");
    ASSERT_TRUE(seen);
    EXPECT_EQ(seen->files, std::set<std::string>{"a"});
    EXPECT_FALSE(walked(directory / "link", 1))
        << "a link below the drop directory is not followed";
}

TEST(TreeWalk, GivesTheStampOfAFile) {
    const testing::TemporaryDirectory directory;
    write_file(directory / "a", "12345");
    int files = 0;
    ASSERT_TRUE(walk(directory.path(), {[](const fs::path&) {},
                                        [&](const fs::path& path, const FileStamp& stamp) {
                                            ++files;
                                            EXPECT_EQ(stamp, look_at(path).stamp);
                                            EXPECT_EQ(stamp.size_bytes, 5U);
                                        },
                                        [](const fs::path&, const Error&) {}}));
    EXPECT_EQ(files, 1);
}

TEST(TreeWalk, SaysWhichDirectoriesItLeftOut) {
    const testing::TemporaryDirectory directory;
    fs::path deep = directory.path();
    for (int i = 0; i <= max_walk_depth; ++i)
        deep /= "d";
    fs::create_directories(deep);
    write_file(deep / "too-deep", "1");
    write_file(deep.parent_path() / "deep-enough", "1");
    const Result<Seen> seen = walked(directory.path());
    ASSERT_TRUE(seen);
    EXPECT_EQ(seen->files.size(), 1U);
    ASSERT_EQ(seen->problems.size(), 1U);
    EXPECT_NE(seen->problems.begin()->find(deep.native()), std::string::npos);
}

TEST(TreeWalk, GoesOnAfterADirectoryThatMayNotBeRead) {
    if (::geteuid() == 0) GTEST_SKIP() << "root may read every directory";
    const testing::TemporaryDirectory directory;
    fs::create_directory(directory / "closed");
    fs::permissions(directory / "closed", fs::perms::none);
    write_file(directory / "open", "1");
    const Result<Seen> seen = walked(directory.path());
    fs::permissions(directory / "closed", fs::perms::owner_all);
    ASSERT_TRUE(seen);
    EXPECT_EQ(seen->files, std::set<std::string>{"open"});
    EXPECT_EQ(seen->problems.size(), 1U);
}

// 2026-11-28: after LDM had removed its empty drop directory and made it again, the service kept
// watching the removed directory, and reported nothing. A bind mount of the service's unit had
// preserved the removed directory.
TEST(TreeWalk, ARootThatAMountAloneKeepsIsAnError) {
    if (::unshare(CLONE_NEWNS) != 0) GTEST_SKIP() << "this machine does not allow mounts";
    const testing::TemporaryDirectory directory;
    ASSERT_EQ(::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr), 0);
    fs::create_directory(directory / "drop");
    fs::create_directory(directory / "seen");
    ASSERT_EQ(::mount((directory / "drop").c_str(), (directory / "seen").c_str(), nullptr, MS_BIND,
                      nullptr),
              0);
    EXPECT_TRUE(walked(directory / "seen"));
    fs::remove(directory / "drop");
    const Result<Seen> dead = walked(directory / "seen");
    ASSERT_FALSE(dead);
    EXPECT_EQ(dead.error().code, ErrorCode::io);
    EXPECT_NE(dead.error().message.find("was deleted"), std::string::npos) << dead.error().message;
    ::umount((directory / "seen").c_str());
}

TEST(TreeWalk, AMissingRootIsAnError) {
    const testing::TemporaryDirectory directory;
    const Result<Seen> missing = walked(directory / "none");
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().code, ErrorCode::not_found);
    write_file(directory / "file", "1");
    EXPECT_FALSE(walked(directory / "file"));
}

}  // namespace
}  // namespace stormcellar::daemon
