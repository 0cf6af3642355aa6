#include "daemon/tree_walk.h"

#include <set>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tests/daemon/write_file.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::daemon {
namespace {

namespace fs = std::filesystem;

struct Seen {
    std::set<std::string> files, directories, problems;
};

Result<Seen> walked(const fs::path& root) {
    Seen seen;
    const Status status =
        walk(root,
             {[&](const fs::path& path) { seen.directories.insert(path.lexically_relative(root)); },
              [&](const fs::path& path, const FileStamp&) {
                  seen.files.insert(path.lexically_relative(root));
              },
              [&](const std::string& problem) { seen.problems.insert(problem); }});
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
                                        [](const std::string&) {}}));
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
