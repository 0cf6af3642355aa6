// Runs the real program on a hostile drop directory. Every refusal has its reason in the log or the
// status, good volumes are gridded, and nothing outside of the configured directories is read or
// written.
#include "tests/daemon/hostile_drop.h"

#include <array>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <sys/un.h>
#include <unistd.h>

#include "tests/testing/program.h"
#include "tests/testing/waiting.h"

namespace stormcellar::daemon {
namespace {

namespace fs = std::filesystem;
namespace wire = level2::wire;
using nlohmann::json;
using wire::Bytes;

// Returns the times of the last read, write and change of a file, and its size.
using Facts = std::array<std::int64_t, 4>;
Facts facts_of(const fs::path& path) {
    struct stat facts {};
    EXPECT_EQ(::lstat(path.c_str(), &facts), 0) << path;
    return {facts.st_atim.tv_sec, facts.st_mtim.tv_sec, facts.st_ctim.tv_nsec, facts.st_size};
}

std::map<fs::path, Facts> facts_below(const fs::path& directory) {
    std::map<fs::path, Facts> all;
    for (const auto& entry : fs::recursive_directory_iterator(directory)) {
        if (entry.is_directory()) continue;
        all[entry.path()] = facts_of(entry.path());
    }
    return all;
}

// Sets an old access time, so that the next read is recorded even with relatime.
void forget_reading(const fs::path& path) {
    const std::array<timespec, 2> times = {timespec{1'000'000'000, 0}, timespec{1'600'000'000, 0}};
    ASSERT_EQ(::utimensat(AT_FDCWD, path.c_str(), times.data(), 0), 0);
}

void make_socket(const fs::path& path) {
    const int socket = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_un address{.sun_family = AF_UNIX, .sun_path = {}};
    path.native().copy(address.sun_path, sizeof address.sun_path - 1);
    ASSERT_EQ(::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    ::close(socket);
}

// Makes one entry of each kind that is neither a file nor a directory. Returns the names.
std::vector<std::string> make_oddities(const fs::path& in, const fs::path& outside) {
    fs::create_directories(in);
    fs::create_symlink(outside / "KTLX_volume", in / "to-a-file");
    fs::create_directory_symlink(outside, in / "to-a-directory");
    fs::create_symlink(outside / "none", in / "dangling");
    fs::create_symlink("loop-b", in / "loop-a");
    fs::create_symlink("loop-a", in / "loop-b");
    fs::create_directory_symlink("..", in / "upwards");
    fs::create_symlink("/proc/self/mem", in / "memory");
    EXPECT_EQ(::mkfifo((in / "fifo").c_str(), 0666), 0);
    make_socket(in / "socket");
    std::vector<std::string> names = {"to-a-file", "to-a-directory", "dangling", "loop-a", "loop-b",
                                      "upwards",   "memory",         "fifo",     "socket"};
    if (::mknod((in / "device").c_str(), S_IFCHR | 0666, makedev(1, 5)) == 0)
        names.emplace_back("device");  // an endless source of zeros
    if (::mknod((in / "disk").c_str(), S_IFBLK | 0666, makedev(7, 0)) == 0)
        names.emplace_back("disk");
    return names;
}

TEST_F(HostileDrop, LinksFifosSocketsAndDevicesAreNamedAndNeverOpened) {
    put(outside() / "KTLX_volume", volume(3));
    forget_reading(outside() / "KTLX_volume");
    put(drop() / "KTLX_first", volume());
    forget_reading(drop() / "KTLX_first");
    const auto before = facts_below(outside());
    const auto names = make_oddities(drop() / "old", outside());
    start();
    make_oddities(drop() / "new", outside());
    put(drop() / "new/KTLX_last", volume());
    ASSERT_TRUE(wait_until_gridded("KTLX_first")) << daemon_.log();
    ASSERT_TRUE(wait_until_gridded("KTLX_last")) << daemon_.log();
    for (const std::string& name : names)
        ASSERT_TRUE(was_said((drop() / "old" / name).native() + ": is a"));
    ASSERT_TRUE(was_said("old/to-a-directory: is a symbolic link, so it is not read"));
    ASSERT_TRUE(was_said("drop/new/"));
    const std::uint64_t scans = daemon_.status()["scans"];
    ASSERT_TRUE(daemon_.wait_for([&](const json& s) { return s["scans"] >= scans + 3; }));
    expect_bounded("links, FIFOs, sockets and devices");
    EXPECT_EQ(daemon_.terminate(), 0);
    EXPECT_EQ(daemon_.status()["rejected"], 0);
    EXPECT_EQ(sweeps_known(), (std::multiset<int>{2, 2}))
        << "a file outside of the drop directory was read";
    EXPECT_EQ(facts_below(outside()), before);
    if (facts_of(drop() / "KTLX_first")[0] == 1'000'000'000)
        std::printf("no times of reading are kept here, so those outside say nothing\n");
    const std::string log = daemon_.log();
    const std::string line = "old/fifo: is a FIFO";
    EXPECT_EQ(log.find(line), log.rfind(line)) << "logged once, not at each scan";
}

// Another process replaces a directory by a link out of the drop directory, thousands of times.
TEST_F(HostileDrop, NamesThatAreSwappedForLinksLeadNowhere) {
    put(drop() / "day/KTLX_a", volume());
    put(outside() / "KTLX_a", volume(3));
    fs::create_directory_symlink(outside(), drop() / "link");
    const auto before = facts_below(outside());
    start();
    const auto exchange = [](const fs::path& a, const fs::path& b) {
        ASSERT_EQ(::renameat2(AT_FDCWD, a.c_str(), AT_FDCWD, b.c_str(), RENAME_EXCHANGE), 0);
    };
    fs::create_symlink(outside() / "KTLX_a", drop() / "file-link");
    put(drop() / "KTLX_b", volume());
    for (int i = 0; i < 400; ++i) {
        exchange(drop() / "day", drop() / "link");
        exchange(drop() / "KTLX_b", drop() / "file-link");
        append_to_file(drop() / (i % 2 == 0 ? "file-link" : "KTLX_b"), "");
        testing::pass_time(std::chrono::milliseconds{5});
    }
    put(drop() / "KTLX_last", volume());
    ASSERT_TRUE(wait_until_gridded("KTLX_last")) << daemon_.log();
    expect_bounded("swapped names");
    EXPECT_EQ(daemon_.terminate(), 0);
    EXPECT_EQ(sweeps_known().count(3), 0U) << daemon_.log();
    EXPECT_EQ(facts_below(outside()).size(), before.size());
}

// The service polls a growing file each second, while the path is changed to lead elsewhere.
TEST_F(HostileDrop, AGrowingFileWhoseDirectoryBecomesALinkIsNotReadOn) {
    const Bytes messages = wire::radial_messages(2, 360);
    Bytes plain = wire::archive_header();
    plain.insert(plain.end(), messages.begin(), messages.begin() + messages.size() / 2);
    put(outside() / "KTLX_a", volume(3));
    forget_reading(outside() / "KTLX_a");
    const auto before = facts_below(outside());
    daemon_.start(
        "[ingest]\nquiet_seconds = 600\n[watch]\nrescan_seconds = 1\n[log]\nlevel = \"debug\"\n");
    ASSERT_TRUE(daemon_.wait_for([](const json& s) { return s["state"] == "running"; }));
    put(drop() / "day/KTLX_a", plain);
    ASSERT_TRUE(daemon_.wait_for_log("waiting for the rest of KTLX")) << daemon_.log();
    fs::create_directory_symlink(outside(), drop() / "link");
    ASSERT_EQ(::renameat2(AT_FDCWD, (drop() / "day").c_str(), AT_FDCWD, (drop() / "link").c_str(),
                          RENAME_EXCHANGE),
              0);
    ASSERT_TRUE(was_said("marked 1 file as gone"));
    EXPECT_EQ(daemon_.terminate(), 0);
    EXPECT_EQ(sweeps_known().count(3), 0U) << daemon_.log();
    EXPECT_EQ(facts_below(outside()), before);
}

TEST_F(HostileDrop, ADropDirectoryBehindALinkIsFine) {
    fs::rename(drop(), daemon_.root() / "spool");
    fs::create_directory_symlink("spool", drop());
    put(drop() / "KTLX_first", volume());
    start();
    put(drop() / "KTLX_last", volume());
    EXPECT_TRUE(wait_until_gridded("spool/KTLX_first")) << daemon_.log();
    EXPECT_TRUE(wait_until_gridded("spool/KTLX_last")) << daemon_.log();
    EXPECT_EQ(daemon_.terminate(), 0);
}

// A hard link is an ordinary file, even if its other names are outside of the drop directory.
TEST_F(HostileDrop, AHardLinkIsAnOrdinaryFile) {
    put(outside() / "KTLX_volume", volume(3));
    start();
    fs::create_hard_link(outside() / "KTLX_volume", drop() / "KTLX_linked");
    ASSERT_TRUE(wait_until_gridded("KTLX_linked")) << daemon_.log();
    EXPECT_EQ(daemon_.terminate(), 0);
    EXPECT_EQ(fs::hard_link_count(outside() / "KTLX_volume"), 2U);
}

TEST_F(HostileDrop, NamesForgeNoLine) {
    const std::vector<std::string> names = {
        "KTLX_a\n2026-11-22T00:00:00.000Z error: forged",
        "KTLX_b\r\x1b[2J\x1b]0;title\x07",
        "KTLX_c\xff\xfe\xc0\xaf",
        "KTLX_d\",\"reason\":\"x\"}],\"forged\":true,\"y\":[{\"z\":\"",
        "-rf",
        "--config",
        "KTLX_{}%s%n$(id)`id`",
        "KTLX_\xe2\x80\xae" + std::string(247, 'x'),
        std::string(255, 'y'),
    };
    start();
    const Bytes nonsense(3000, std::byte{'x'});
    for (const std::string& name : names)
        put(drop() / name, nonsense);
    for (const std::string& name : names)
        put(drop() / ("in " + name.substr(0, 200)) / "KTLX_volume", volume());
    fs::create_symlink("nowhere", drop() / "link\n2026-11-22T00:00:00.000Z error: forged");
    ASSERT_TRUE(wait_until_rejected(names.size())) << daemon_.log();
    ASSERT_TRUE(daemon_.wait_for([&](const json& status) {
        return status["ingested"] >= names.size();
    })) << daemon_.log();
    ASSERT_TRUE(was_said("link\\x0a2026"));
    expect_bounded("hostile names");
    EXPECT_FALSE(daemon_.status().contains("forged"));
    const auto said = testing::run_program(
        STORMCELLAR_PROGRAM,
        {"catalog", "list", "--catalog", daemon_.catalog().native(), "--station", "KTLX"});
    EXPECT_EQ(said.out.find("\n2026-11-22T00:00:00.000Z error"), std::string::npos);
    EXPECT_EQ(said.out.find('\x1b'), std::string::npos);
    const auto status = testing::run_program(
        STORMCELLAR_PROGRAM, {"status", "--state", (daemon_.root() / "state").native()});
    EXPECT_EQ(status.out.find("\n2026-11-22T00:00:00.000Z error"), std::string::npos);
    EXPECT_EQ(status.out.find('\x1b'), std::string::npos);
    EXPECT_EQ(daemon_.terminate(), 0);
    std::istringstream log(daemon_.log());
    const std::regex whole(
        R"(\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}Z (debug|info|warning|error): .*)");
    for (std::string line; std::getline(log, line);) {
        EXPECT_TRUE(std::regex_match(line, whole)) << line;
        EXPECT_FALSE(line.starts_with("2026-11-22T00:00:00.000Z")) << line;
        EXPECT_EQ(line.find('\x1b'), std::string::npos);
    }
}

// Runs the daemon as a user who does not own the files, because root may read everything.
TEST_F(HostileDrop, WhatMayNotBeReadIsNamedAndTakenOnceItMay) {
    if (::geteuid() != 0) GTEST_SKIP() << "only root can run the daemon as another user";
    put(drop() / "KTLX_closed", volume());
    put(drop() / "closed/KTLX_in_closed", volume());
    put(drop() / "blind/KTLX_in_blind", volume());
    fs::permissions(drop() / "KTLX_closed", fs::perms::none);
    fs::permissions(drop() / "closed", fs::perms::none);
    fs::permissions(drop() / "blind", fs::perms::owner_read | fs::perms::others_read);
    ASSERT_EQ(::chown(daemon_.root().c_str(), 65534, 65534), 0);
    daemon_.run_under({"setpriv", "--reuid=65534", "--regid=65534", "--clear-groups"});
    start();
    ASSERT_TRUE(wait_until_rejected(1)) << daemon_.log();
    EXPECT_EQ(reason_of("KTLX_closed"), "Permission denied");
    ASSERT_TRUE(was_said("drop/closed: Permission denied"));
    ASSERT_TRUE(was_said("drop/blind: Permission denied"));
    put(drop() / "KTLX_good", volume());
    ASSERT_TRUE(wait_until_gridded("KTLX_good")) << daemon_.log();
    for (const char* name : {"KTLX_closed", "closed", "blind"})
        fs::permissions(drop() / name, fs::perms{0755});
    for (const char* name : {"KTLX_closed", "KTLX_in_closed", "KTLX_in_blind"})
        EXPECT_TRUE(wait_until_gridded(name)) << name << '\n' << daemon_.log();
    EXPECT_EQ(daemon_.status()["failures"], 0);
    expect_bounded("no permission");
    EXPECT_EQ(daemon_.terminate(), 0);
}

}  // namespace
}  // namespace stormcellar::daemon
