#include "stormcellar/base/file_system.h"

#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/host_name.h"
#include "tests/repository/text_of.h"
#include "tests/testing/power_cut_file_system.h"
#include "tests/testing/temporary_directory.h"
#include "tests/testing/text_bytes.h"

namespace stormcellar {
namespace {

namespace fs = std::filesystem;
using testing::PowerCutFileSystem;
using testing::TemporaryDirectory;

int entries(const fs::path& directory) {
    return static_cast<int>(std::distance(fs::directory_iterator(directory), {}));
}

TEST(AtomicFile, AppearsWholeUnderItsName) {
    const TemporaryDirectory directory;
    ASSERT_TRUE(
        write_file_atomically(real_file_system(), directory / "a", testing::text_bytes("storm")));
    EXPECT_EQ(testing::text_of(directory / "a"), "storm");
    EXPECT_EQ(entries(directory.path()), 1);
}

// Several hosts may write into one directory, and their processes may have the same id.
TEST(AtomicFile, ItsTemporaryNameSaysHostAndProcess) {
    const TemporaryDirectory directory;
    const auto file = AtomicFile::create(real_file_system(), directory / "a");
    ASSERT_TRUE(file);
    const std::string name = file->temporary_path().filename().string();
    EXPECT_TRUE(name.starts_with(own_temporary_prefix())) << name;
    EXPECT_EQ(own_temporary_prefix(),
              fmt::format("{}{}-{}-", temporary_prefix, host_name(), ::getpid()));
    EXPECT_FALSE(host_name().empty());
    EXPECT_EQ(host_name().find_first_of("./-"), std::string::npos);
}

TEST(AtomicFile, WithoutCommitLeavesNothing) {
    const TemporaryDirectory directory;
    {
        auto file = AtomicFile::create(real_file_system(), directory / "a");
        ASSERT_TRUE(file);
        ASSERT_TRUE(file->append(testing::text_bytes("half")));
    }
    EXPECT_EQ(entries(directory.path()), 0);
}

TEST(AtomicFile, MissingDirectoryIsNotFoundAndNamed) {
    const auto status = write_file_atomically(real_file_system(), "/nonexistent-directory/a",
                                              testing::text_bytes("x"));
    ASSERT_FALSE(status);
    EXPECT_EQ(status.error().code, ErrorCode::not_found);
    EXPECT_NE(status.error().message.find("/nonexistent-directory"), std::string::npos);
}

// A failure at any operation of a replacement, followed by a power cut, leaves the whole old or the
// whole new contents.
TEST(AtomicFile, PowerCutAtEveryOperationLeavesOldOrNew) {
    std::uint64_t operation = 0;
    for (bool finished = false; !finished; ++operation) {
        const TemporaryDirectory directory;
        ASSERT_TRUE(
            write_file_atomically(real_file_system(), directory / "a", testing::text_bytes("old")));
        PowerCutFileSystem file_system;
        file_system.fail_from(operation);
        finished = write_file_atomically(file_system, directory / "a", testing::text_bytes("new"))
                       .has_value();
        file_system.power_cut();
        const std::string now = testing::text_of(directory / "a");
        EXPECT_TRUE(now == "old" || now == "new") << "operation " << operation << ": " << now;
        if (finished) {
            EXPECT_EQ(now, "new") << "a commit that succeeded must last";
        }
    }
    EXPECT_GE(operation, 5U) << "create, write, sync, rename, directory sync";
}

TEST(AtomicFile, FullDiskIsNoSpaceAndLeavesNothing) {
    const TemporaryDirectory directory;
    PowerCutFileSystem file_system;
    file_system.set_space(3);
    const auto status =
        write_file_atomically(file_system, directory / "a", testing::text_bytes("storm"));
    ASSERT_FALSE(status);
    EXPECT_EQ(status.error().code, ErrorCode::no_space);
    EXPECT_EQ(entries(directory.path()), 0);
}

TEST(ReadFile, GivesAllBytes) {
    const TemporaryDirectory directory;
    const std::string text(200'000, 'x');
    std::ofstream(directory / "a") << text;
    const auto bytes = read_file(directory / "a");
    ASSERT_TRUE(bytes);
    EXPECT_EQ(bytes->size(), text.size());
}

TEST(ReadFile, EmptyFileIsNoError) {
    const TemporaryDirectory directory;
    std::ofstream(directory / "a").flush();
    const auto bytes = read_file(directory / "a");
    ASSERT_TRUE(bytes);
    EXPECT_TRUE(bytes->empty());
}

TEST(ReadFile, DirectoryFifoMissingAndTooLargeAreNamed) {
    const TemporaryDirectory directory;
    EXPECT_EQ(read_file(directory.path()).error().code, ErrorCode::not_a_file);
    ASSERT_EQ(::mkfifo((directory / "fifo").c_str(), 0600), 0);
    EXPECT_EQ(read_file(directory / "fifo").error().code, ErrorCode::not_a_file);
    EXPECT_EQ(read_file(directory / "missing").error().code, ErrorCode::not_found);
    std::ofstream(directory / "big") << "12345";
    EXPECT_EQ(read_file(directory / "big", 4).error().code, ErrorCode::unsupported);
}

// A rename over a device, a FIFO or a directory would destroy it.
TEST(AtomicFileTarget, OnlyRegularFilesAreReplaced) {
    const testing::TemporaryDirectory directory;
    ASSERT_EQ(::mkfifo((directory / "fifo").c_str(), 0600), 0);
    std::filesystem::create_directory(directory / "directory");
    std::filesystem::create_symlink("nowhere", directory / "dangling");
    for (const char* name : {"fifo", "directory", "dangling"}) {
        const auto created = AtomicFile::create(real_file_system(), directory / name);
        ASSERT_FALSE(created) << name;
        EXPECT_EQ(created.error().code, ErrorCode::not_a_file);
        EXPECT_NE(created.error().message.find(name), std::string::npos);
        EXPECT_FALSE(check_target(directory / name));
    }
    EXPECT_TRUE(std::filesystem::is_fifo(directory / "fifo"));
}

TEST(AtomicFileTarget, ALinkIsFollowed) {
    const testing::TemporaryDirectory directory;
    std::filesystem::create_directory(directory / "elsewhere");
    ASSERT_TRUE(write_file_atomically(real_file_system(), directory / "elsewhere/file", {}));
    std::filesystem::create_symlink("elsewhere/file", directory / "link");
    const std::vector<std::byte> bytes(3);
    EXPECT_TRUE(check_target(directory / "link"));
    ASSERT_TRUE(write_file_atomically(real_file_system(), directory / "link", bytes));
    EXPECT_TRUE(std::filesystem::is_symlink(directory / "link"));
    EXPECT_EQ(std::filesystem::file_size(directory / "elsewhere/file"), 3U);
}

TEST(AtomicFileTarget, AMissingDirectoryIsToldUnderTheFilesOwnName) {
    const testing::TemporaryDirectory directory;
    const auto created = AtomicFile::create(real_file_system(), directory / "none/file");
    ASSERT_FALSE(created);
    EXPECT_NE(created.error().message.find("none/file: cannot be created: No such file"),
              std::string::npos)
        << created.error().message;
    const Status target = check_target(directory / "none/file");
    ASSERT_FALSE(target);
    EXPECT_EQ(target.error().code, ErrorCode::not_found);
    EXPECT_TRUE(check_target(directory / "file"));
}

}  // namespace
}  // namespace stormcellar
