// Tests the daemon that a benchmark starts.
#include <array>
#include <csignal>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "bench/process.h"
#include "tests/testing/program.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::bench {
namespace {

std::filesystem::path stormcellard() {
    return std::filesystem::path{BENCH_DIRECTORY}.parent_path() / "daemon/stormcellard";
}

// Returns true if the process runs; a zombie does not count as running.
bool runs(pid_t process) {
    std::ifstream file(fmt::format("/proc/{}/stat", process));
    std::string line;
    if (!std::getline(file, line)) return false;
    const std::size_t end_of_name = line.rfind(')');
    return end_of_name != std::string::npos && line.at(end_of_name + 2) != 'Z';
}

TEST(DaemonProcess, IsStartedAndStopped) {
    const testing::TemporaryDirectory directory;
    DaemonProcess daemon(directory.path(), stormcellard());
    const Status started = daemon.start("");
    ASSERT_TRUE(started) << started.error().message;
    EXPECT_TRUE(daemon.is_running());
    EXPECT_TRUE(runs(daemon.id()));
    EXPECT_EQ(daemon.status().state, "running");
    EXPECT_TRUE(daemon.stop());
    EXPECT_FALSE(daemon.is_running());
    DaemonProcess none(directory.path(), directory / "nothing");
    ASSERT_FALSE(none.start(""));
    EXPECT_EQ(none.id(), 0);
}

// 2026-11-22: the daemon went on when the benchmark was killed.
TEST(DaemonProcess, EndsWithWhoeverStartedIt) {
    const testing::TemporaryDirectory directory;
    std::array<int, 2> ends{};
    ASSERT_EQ(::pipe(ends.data()), 0);
    const pid_t starter = ::fork();
    ASSERT_GE(starter, 0);
    if (starter == 0) {
        DaemonProcess daemon(directory.path(), stormcellard());
        const pid_t id = daemon.start("") ? daemon.id() : 0;
        if (::write(ends[1], &id, sizeof id) != sizeof id) ::_exit(1);
        for (;;)
            ::pause();
    }
    pid_t daemon = 0;
    EXPECT_EQ(::read(ends[0], &daemon, sizeof daemon), static_cast<ssize_t>(sizeof daemon));
    ASSERT_GT(daemon, 0);
    EXPECT_TRUE(runs(daemon));
    ::kill(starter, SIGKILL);
    ::waitpid(starter, nullptr, 0);
    EXPECT_TRUE(testing::RunningProgram::wait_for([&] { return !runs(daemon); }));
    ::close(ends[0]);
    ::close(ends[1]);
}

}  // namespace
}  // namespace stormcellar::bench
