#include "base/beneath.h"

#include <algorithm>
#include <csignal>
#include <cstdio>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/testing/temporary_directory.h"

namespace stormcellar {
namespace {

namespace fs = std::filesystem;

class Beneath : public ::testing::Test {
  protected:
    Beneath() {
        fs::create_directories(root() / "day/site");
        fs::create_directories(outside() / "site");
        write(root() / "day/site/file", "inside");
        write(outside() / "site/file", "outside");
    }
    [[nodiscard]] fs::path root() const { return directory_ / "root"; }
    [[nodiscard]] fs::path outside() const { return directory_ / "outside"; }
    static void write(const fs::path& path, std::string_view text) {
        ASSERT_TRUE(write_file_atomically(real_file_system(), path,
                                          std::as_bytes(std::span{text.data(), text.size()})));
    }
    // Returns the contents of the file, or the error.
    [[nodiscard]] std::string read(const fs::path& path) const {
        const auto bytes = read_beneath(root(), path);
        if (!bytes) {
            EXPECT_TRUE(bytes.error().message.starts_with(path.native())) << bytes.error().message;
            return "error " + std::to_string(static_cast<int>(bytes.error().code));
        }
        return {reinterpret_cast<const char*>(bytes->data()), bytes->size()};
    }
    static std::string error(ErrorCode code) {
        return "error " + std::to_string(static_cast<int>(code));
    }
    testing::TemporaryDirectory directory_;
};

TEST_F(Beneath, ReadsWhatLiesThere) {
    EXPECT_EQ(read(root() / "day/site/file"), "inside");
    EXPECT_EQ(read(root() / "day/./site//file"), "inside");
    const auto facts = look_beneath(root(), root() / "day/site/file");
    ASSERT_TRUE(facts);
    EXPECT_EQ(facts->st_size, 6);
    EXPECT_EQ(read(root() / "day/site/none"), error(ErrorCode::not_found));
    EXPECT_EQ(read(root() / "none/file"), error(ErrorCode::not_found));
    EXPECT_EQ(read(root() / "day"), error(ErrorCode::not_a_file));
    EXPECT_EQ(read(root()), error(ErrorCode::not_a_file));
}

TEST_F(Beneath, NoLinkBelowTheRootIsFollowed) {
    fs::create_symlink(outside() / "site/file", root() / "day/link");
    fs::create_symlink("site/file", root() / "day/inner");
    fs::create_directory_symlink(outside(), root() / "away");
    fs::create_directory_symlink("site", root() / "day/near");
    EXPECT_EQ(read(root() / "day/link"), error(ErrorCode::not_a_file));
    EXPECT_EQ(read(root() / "day/inner"), error(ErrorCode::not_a_file))
        << "a link is refused even if its target is below the root";
    EXPECT_EQ(read(root() / "away/site/file"), error(ErrorCode::not_found));
    EXPECT_EQ(read(root() / "day/near/file"), error(ErrorCode::not_found));
    EXPECT_FALSE(look_beneath(root(), root() / "away/site/file"));
    EXPECT_FALSE(names_beneath(root(), root() / "away/site"));
    EXPECT_FALSE(names_beneath(root(), root() / "away"));
}

TEST_F(Beneath, ADirectoryThatBecomesALinkLeadsNowhere) {
    EXPECT_EQ(read(root() / "day/site/file"), "inside");
    fs::rename(root() / "day", root() / "was");
    fs::create_directory_symlink(outside(), root() / "day");
    EXPECT_EQ(read(root() / "day/site/file"), error(ErrorCode::not_found));
}

TEST_F(Beneath, NothingOutsideIsNamed) {
    EXPECT_EQ(read(outside() / "site/file"), error(ErrorCode::not_found));
    EXPECT_EQ(read(root() / "day/../../outside/site/file"), error(ErrorCode::not_found));
    EXPECT_EQ(read(fs::path{root().native() + "2"} / "file"), error(ErrorCode::not_found));
}

TEST_F(Beneath, TheRootMayBeALink) {
    fs::create_directory_symlink(root(), directory_ / "alias");
    const auto bytes = read_beneath(directory_ / "alias", directory_ / "alias/day/site/file");
    ASSERT_TRUE(bytes) << bytes.error().message;
    EXPECT_EQ(bytes->size(), 6U);
}

TEST_F(Beneath, WithoutARootOnlyTheFileItselfMayNotBeALink) {
    fs::create_directory_symlink(outside(), root() / "away");
    EXPECT_TRUE(read_beneath({}, root() / "away/site/file"));
    fs::create_symlink("site/file", root() / "day/inner");
    EXPECT_FALSE(read_beneath({}, root() / "day/inner"));
    EXPECT_TRUE(names_beneath({}, root() / "away/site"));
}

TEST_F(Beneath, WhatIsNoFileIsNamedAndNeverBlocks) {
    ASSERT_EQ(::mkfifo((root() / "fifo").c_str(), 0600), 0);
    fs::create_symlink("nowhere", root() / "dangling");
    fs::create_symlink("b", root() / "a");
    fs::create_symlink("a", root() / "b");
    const auto reason = [&](const char* name) {
        const auto opened = open_beneath(root(), root() / name);
        return opened ? "opened" : opened.error().message.substr((root() / name).native().size());
    };
    EXPECT_EQ(reason("fifo"), ": is a FIFO");
    EXPECT_EQ(reason("dangling"), ": is a symbolic link");
    EXPECT_EQ(reason("a"), ": is a symbolic link");
    EXPECT_EQ(reason("day"), ": is a directory");
    const int socket = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_un address{.sun_family = AF_UNIX, .sun_path = {}};
    (root() / "s").native().copy(address.sun_path, sizeof address.sun_path - 1);
    ASSERT_EQ(::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    EXPECT_EQ(reason("s"), ": is a socket");
    ::close(socket);
}

TEST_F(Beneath, ALargeSparseFileIsRefusedByItsSize) {
    write(root() / "sparse", "x");
    fs::resize_file(root() / "sparse", std::uintmax_t{1} << 40U);
    EXPECT_EQ(read(root() / "sparse"), error(ErrorCode::unsupported));
    EXPECT_TRUE(read_beneath(root(), root() / "day/site/file", 6));
    EXPECT_FALSE(read_beneath(root(), root() / "day/site/file", 5));
}

TEST_F(Beneath, NamesAreThoseOfTheDirectory) {
    write(root() / "day/.hidden", "");
    auto names = names_beneath(root(), root() / "day");
    ASSERT_TRUE(names);
    std::sort(names->begin(), names->end());
    EXPECT_EQ(*names, (std::vector<std::string>{".hidden", "site"}));
    EXPECT_TRUE(names_beneath(root(), root()));
    EXPECT_FALSE(names_beneath(root(), root() / "day/site/file"));
}

// A program that swaps names while we read never makes us read a file outside the root.
TEST_F(Beneath, LinksThatComeAndGoLeadNowhere) {
    fs::create_directory_symlink(outside(), root() / "link");
    const pid_t child = ::fork();
    if (child == 0) {
        for (;;)
            ::renameat2(AT_FDCWD, (root() / "day").c_str(), AT_FDCWD, (root() / "link").c_str(),
                        RENAME_EXCHANGE);
    }
    int inside = 0;
    for (int i = 0; i < 20'000; ++i) {
        const auto bytes = read_beneath(root(), root() / "day/site/file");
        if (!bytes) continue;
        ++inside;
        EXPECT_EQ(bytes->size(), 6U) << "read a file outside the root";
        if (bytes->size() != 6) break;
    }
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    EXPECT_GT(inside, 0);
}

}  // namespace
}  // namespace stormcellar
