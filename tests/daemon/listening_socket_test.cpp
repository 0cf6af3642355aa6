#include "daemon/status/listening_socket.h"

#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/testing/temporary_directory.h"

namespace stormcellar::daemon {
namespace {

mode_t mode_of(const std::filesystem::path& path) {
    struct stat found {};
    EXPECT_EQ(::stat(path.c_str(), &found), 0);
    return found.st_mode & 07777;
}

// 2026-11-25: the mode of the socket was set by name after the socket was made. If somebody had put
// a link in place of the socket, the mode of the link's target was set. Now the socket is created
// with its mode.
TEST(ListeningSocket, ItsModeIsThereWhenItStands) {
    const testing::TemporaryDirectory directory;
    const mode_t umask_before = ::umask(0);
    const auto open = ListeningSocket::at_path(directory / "open");
    ::umask(0027);
    const auto narrow = ListeningSocket::at_path(directory / "narrow");
    ::umask(umask_before);
    ASSERT_TRUE(open && narrow);
    EXPECT_EQ(mode_of(directory / "open"), 0660U);
    EXPECT_EQ(mode_of(directory / "narrow"), 0640U) << "the umask reduces the mode";
}

TEST(ListeningSocket, SaysWhyItCannotBe) {
    const testing::TemporaryDirectory directory;
    const auto reason = [](const std::filesystem::path& path) {
        const auto socket = ListeningSocket::at_path(path);
        return socket ? ErrorCode::internal : socket.error().code;
    };
    EXPECT_EQ(reason(""), ErrorCode::bad_argument);
    EXPECT_EQ(reason("/" + std::string(107, 'x')), ErrorCode::bad_argument);
    EXPECT_EQ(reason(directory / "none/s"), ErrorCode::not_found);
    EXPECT_EQ(reason(directory.path()), ErrorCode::io) << "the path is a directory";
    const auto first = ListeningSocket::at_path(directory / "s");
    ASSERT_TRUE(first);
    EXPECT_EQ(reason(directory / "s"), ErrorCode::busy) << "a program answers at the path";
    EXPECT_TRUE(first->still_stands());
    std::filesystem::remove(directory / "s");
    EXPECT_FALSE(first->still_stands());
}

}  // namespace
}  // namespace stormcellar::daemon
