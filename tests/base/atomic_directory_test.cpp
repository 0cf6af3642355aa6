#include "base/atomic_directory.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "tests/testing/power_cut_file_system.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar {
namespace {

namespace fs = std::filesystem;

Status always(const fs::path& /*directory*/) {
    return {};
}
Status never(const fs::path& /*directory*/) {
    return fail(ErrorCode::bad_argument, "is precious");
}

std::span<const std::byte> bytes_of(std::string_view text) {
    return std::as_bytes(std::span(text));
}

std::string text_of(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

std::ptrdiff_t count_in(const fs::path& directory) {
    return std::distance(fs::directory_iterator(directory), {});
}

TEST(AtomicDirectory, AppearsWholeWithItsDirectories) {
    const testing::TemporaryDirectory around;
    const fs::path target = around.path() / "a";
    auto directory = AtomicDirectory::create(real_file_system(), target, always);
    ASSERT_TRUE(directory) << directory.error().message;
    ASSERT_TRUE(directory->write("one", bytes_of("1")));
    ASSERT_TRUE(directory->write("deep/er/two", bytes_of("22")));
    EXPECT_FALSE(fs::exists(target));
    ASSERT_TRUE(directory->commit());
    EXPECT_EQ(text_of(target / "one"), "1");
    EXPECT_EQ(text_of(target / "deep/er/two"), "22");
    EXPECT_EQ(count_in(around.path()), 1);
}

TEST(AtomicDirectory, WithoutCommitNothingIsLeft) {
    const testing::TemporaryDirectory around;
    {
        auto directory = AtomicDirectory::create(real_file_system(), around.path() / "a", always);
        ASSERT_TRUE(directory);
        ASSERT_TRUE(directory->write("deep/one", bytes_of("1")));
    }
    EXPECT_EQ(count_in(around.path()), 0);
}

TEST(AtomicDirectory, ReplacesOnlyWhatItMay) {
    const testing::TemporaryDirectory around;
    const fs::path target = around.path() / "a", file = around.path() / "file";
    fs::create_directory(target);
    std::ofstream(target / "old") << "old";
    std::ofstream(file) << "file";
    EXPECT_EQ(AtomicDirectory::create(real_file_system(), target, never).error().message,
              "is precious");
    EXPECT_EQ(AtomicDirectory::check(file, always).error().code, ErrorCode::not_a_file);
    EXPECT_EQ(AtomicDirectory::check(around.path() / "no/a", always).error().code,
              ErrorCode::not_found);
    auto directory = AtomicDirectory::create(real_file_system(), target, always);
    ASSERT_TRUE(directory);
    ASSERT_TRUE(directory->write("new", bytes_of("new")));
    ASSERT_TRUE(directory->commit());
    EXPECT_FALSE(fs::exists(target / "old"));
    EXPECT_EQ(text_of(target / "new"), "new");
    EXPECT_EQ(count_in(around.path()), 2);
}

TEST(AtomicDirectory, SurvivesAPowerCutAfterCommit) {
    const testing::TemporaryDirectory around;
    testing::PowerCutFileSystem file_system;
    auto directory = AtomicDirectory::create(file_system, around.path() / "a", always);
    ASSERT_TRUE(directory);
    ASSERT_TRUE(directory->write("deep/one", bytes_of("1")));
    ASSERT_TRUE(directory->commit());
    file_system.power_cut();
    EXPECT_EQ(text_of(around.path() / "a/deep/one"), "1");
}

}  // namespace
}  // namespace stormcellar
