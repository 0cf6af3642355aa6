// The real program on a drop directory that means harm: memory and time stay bounded, every refusal
// has its reason in the log or the status, good volumes beside are gridded, and nothing outside of
// the configured directories is read or written.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <thread>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <sys/un.h>
#include <unistd.h>

#include "catalog/catalog.h"
#include "tests/daemon/running_daemon.h"
#include "tests/daemon/write_file.h"
#include "tests/level2/wire.h"
#include "tests/testing/program.h"

namespace stormcellar::daemon {
namespace {

namespace fs = std::filesystem;
namespace wire = level2::wire;
using nlohmann::json;
using wire::Bytes;

// With two workers; what a volume of a radar takes is a fifth of it.
constexpr long most_mib = 1024;
constexpr double most_seconds = 60;  // for what takes a second or two where nothing else runs

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool memory_is_ours = false;
#else
constexpr bool memory_is_ours = true;
#endif

constexpr const char* hasty =
    "[ingest]\nworkers = 2\nthreads = 2\nquiet_seconds = 1\nspacing_km = 4\n"
    "[watch]\nrescan_seconds = 1\n[log]\nlevel = \"debug\"\n";

class HostileDrop : public ::testing::Test {
  protected:
    HostileDrop() { fs::create_directory(outside()); }

    [[nodiscard]] fs::path drop() const { return daemon_.drop(); }
    [[nodiscard]] fs::path outside() const { return daemon_.root() / "outside"; }
    static void put(const fs::path& path, const Bytes& bytes) {
        fs::create_directories(path.parent_path());
        write_file(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    }
    // A volume of the site of the tests; each with its own number of sweeps is told by it.
    static Bytes volume(unsigned sweeps = 2) { return wire::ldm_volume(sweeps, 360); }
    void start() {
        daemon_.start(hasty);
        ASSERT_TRUE(daemon_.wait_for([](const json& s) { return s["state"] == "running"; }))
            << daemon_.log();
    }
    bool wait_until_gridded(const std::string& name) {
        return daemon_.wait_for([&](const json& status) {
            return std::any_of(
                status["volumes"].begin(), status["volumes"].end(),
                [&](const json& file) { return std::string{file["file"]}.ends_with(name); });
        });
    }
    bool wait_until_rejected(std::size_t files) {
        return daemon_.wait_for([&](const json& status) { return status["rejected"] >= files; });
    }
    // The reason for which a file was rejected; empty where it was not.
    std::string reason_of(const std::string& name) {
        const json status = daemon_.status();
        for (const json& file : status["rejected_files"]) {
            if (std::string{file["file"]}.ends_with(name)) return file["reason"];
        }
        return {};
    }
    bool was_said(const std::string& text) {
        if (daemon_.wait_for_log(text)) return true;
        std::printf("%s is not in\n%s", text.c_str(), daemon_.log().c_str());
        return false;
    }
    void expect_bounded(const char* what) {
        const long peak = daemon_.peak_mib();
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin_;
        std::printf("%s: peak %ld MiB, %.2f s\n", what, peak, took.count());
        EXPECT_GT(peak, 0);
        if (memory_is_ours) {
            EXPECT_LT(peak, most_mib);
        }
        EXPECT_LT(took.count(), most_seconds);
    }
    // How many sweeps the volumes have that the catalog knows, in any state.
    std::multiset<int> sweeps_known() {
        std::multiset<int> sweeps;
        auto catalog = catalog::Catalog::open_for_reading(daemon_.catalog());
        if (!catalog) return sweeps;
        const auto entries = catalog->list("KTLX", {std::nullopt, std::nullopt, true});
        if (!entries) return sweeps;
        for (const catalog::CatalogEntry& entry : *entries)
            sweeps.insert(entry.volume.sweep_count);
        return sweeps;
    }

    RunningDaemon daemon_;
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

// When a file was read last, written last and changed last, and its size.
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

// Read long ago, so that the next reading is noted even where few are (relatime).
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

// Everything that may stand in a directory and is neither file nor directory. Gives the names.
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
        names.emplace_back("device");  // of zeros without end
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
    ASSERT_TRUE(was_said("old/to-a-directory: is a symbolic link: left out"));
    ASSERT_TRUE(was_said("drop/new/"));
    const std::uint64_t scans = daemon_.status()["scans"];
    ASSERT_TRUE(daemon_.wait_for([&](const json& s) { return s["scans"] >= scans + 3; }));
    expect_bounded("links, FIFOs, sockets and devices");
    EXPECT_EQ(daemon_.terminate(), 0);
    EXPECT_EQ(daemon_.status()["rejected"], 0);
    EXPECT_EQ(sweeps_known(), (std::multiset<int>{2, 2})) << "what lies outside was read";
    EXPECT_EQ(facts_below(outside()), before);
    if (facts_of(drop() / "KTLX_first")[0] == 1'000'000'000)
        std::printf("no times of reading are kept here, so those outside say nothing\n");
    const std::string log = daemon_.log();
    const std::string line = "old/fifo: is a FIFO";
    EXPECT_EQ(log.find(line), log.rfind(line)) << "said once, not with each scan";
}

// Somebody exchanges a directory for a link to another one, thousands of times.
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
        std::this_thread::sleep_for(std::chrono::milliseconds{5});
    }
    put(drop() / "KTLX_last", volume());
    ASSERT_TRUE(wait_until_gridded("KTLX_last")) << daemon_.log();
    expect_bounded("swapped names");
    EXPECT_EQ(daemon_.terminate(), 0);
    EXPECT_EQ(sweeps_known().count(3), 0U) << daemon_.log();
    EXPECT_EQ(facts_below(outside()).size(), before.size());
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

// A hard link is the file itself, wherever its other names are.
TEST_F(HostileDrop, AHardLinkIsAnOrdinaryFile) {
    put(outside() / "KTLX_volume", volume(3));
    start();
    fs::create_hard_link(outside() / "KTLX_volume", drop() / "KTLX_linked");
    ASSERT_TRUE(wait_until_gridded("KTLX_linked")) << daemon_.log();
    EXPECT_EQ(daemon_.terminate(), 0);
    EXPECT_EQ(fs::hard_link_count(outside() / "KTLX_volume"), 2U);
}

TEST_F(HostileDrop, HugeSparseFilesAreRefusedBySize) {
    constexpr std::uintmax_t tebibyte = std::uintmax_t{1} << 40U;
    const Bytes messages = wire::radial_messages(2, 360);
    const Bytes begun = wire::join(
        {wire::archive_header(), wire::ldm_record(std::span{messages}.first(messages.size() / 2))});
    put(drop() / "zeros", {});
    put(drop() / "KTLX_before", begun);
    for (const char* name : {"zeros", "KTLX_before"})
        fs::resize_file(drop() / name, tebibyte);
    start();
    put(drop() / "KTLX/7/20220317-000842-001-S", begun);
    put(drop() / "KTLX_growing", begun);
    ASSERT_TRUE(daemon_.wait_for_log("waiting for the rest of KTLX")) << daemon_.log();
    fs::resize_file(drop() / "KTLX/7/20220317-000842-001-S", tebibyte);
    for (std::uintmax_t size = 1U << 20U; size <= tebibyte; size *= 4)
        fs::resize_file(drop() / "KTLX_growing", size);
    put(drop() / "KTLX_good", volume());
    ASSERT_TRUE(wait_until_gridded("KTLX_good")) << daemon_.log();
    ASSERT_TRUE(wait_until_rejected(4)) << daemon_.log();
    for (const char* name : {"zeros", "KTLX_before", "20220317-000842-001-S", "KTLX_growing"}) {
        EXPECT_EQ(reason_of(name),
                  "1099511627776 bytes, and a raw file may have 268435456: not read")
            << name;
    }
    expect_bounded("sparse files of 1 TiB");
    EXPECT_EQ(daemon_.terminate(), 0);
}

// The largest that is read: all zeros, and a volume with zeros behind.
TEST_F(HostileDrop, SparseFilesBelowTheLimitAreReadAndStayBounded) {
    for (int i = 0; i < 4; ++i) {
        const fs::path path = drop() / ("KTLX_" + std::to_string(i));
        put(path, i % 2 == 0 ? Bytes{} : volume());
        fs::resize_file(path, (std::uintmax_t{256} << 20U) - 1);
    }
    start();
    ASSERT_TRUE(wait_until_rejected(2)) << daemon_.log();
    put(drop() / "KTLX_good", volume());
    ASSERT_TRUE(wait_until_gridded("KTLX_good")) << daemon_.log();
    expect_bounded("sparse files of 256 MiB");
    EXPECT_EQ(daemon_.terminate(), 0);
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

// As another user than the one who owns the files: root may read everything.
TEST_F(HostileDrop, WhatMayNotBeReadIsNamedAndTakenOnceItMay) {
    if (::geteuid() != 0) GTEST_SKIP() << "only root can run it as a user without rights";
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

// `records` of 45 MB each, in some 90 bytes each.
Bytes bomb_records(unsigned records) {
    static const Bytes stream = wire::bzip2(Bytes(45'000'000));
    const Bytes record =
        wire::Writer{}.u32(static_cast<std::uint32_t>(stream.size())).raw(stream).bytes;
    Bytes all;
    for (unsigned i = 0; i < records; ++i)
        all.insert(all.end(), record.begin(), record.end());
    return all;
}

Bytes first_record() {
    const Bytes messages = wire::radial_messages(2, 360);
    return wire::join(
        {wire::archive_header(), wire::ldm_record(std::span{messages}.first(messages.size() / 2))});
}

TEST_F(HostileDrop, BombsOfBzip2AreRejectedAndAGoodVolumeBesideIsGridded) {
    const Bytes bomb = wire::join({first_record(), bomb_records(1000)});
    std::printf("%zu bytes that unpack to 45 GB\n", bomb.size());
    for (int i = 0; i < 3; ++i)
        put(drop() / ("KTLX_bomb" + std::to_string(i)), bomb);
    put(drop() / "KTLX_packed", wire::bzip2(wire::join({first_record(), bomb_records(20)})));
    start();
    for (int i = 3; i < 6; ++i)
        put(drop() / ("KTLX_bomb" + std::to_string(i)), bomb);
    put(drop() / "KTLX_good", volume());
    ASSERT_TRUE(wait_until_gridded("KTLX_good")) << daemon_.log();
    const double latency = daemon_.status()["volumes"][0]["latency_s"];
    std::printf("the good volume was gridded %.2f s after its close\n", latency);
    EXPECT_LT(latency, most_seconds / 2);
    ASSERT_TRUE(wait_until_rejected(7)) << daemon_.log();
    for (const char* name : {"KTLX_bomb0", "KTLX_bomb5", "KTLX_packed"})
        EXPECT_NE(reason_of(name).find("limit"), std::string::npos) << name << reason_of(name);
    expect_bounded("bombs of bzip2");
    EXPECT_EQ(daemon_.terminate(), 0);
}

TEST_F(HostileDrop, BombsThatGrowOrComeAsChunksAreGivenUp) {
    start();
    put(drop() / "KTLX_growing", first_record());
    ASSERT_TRUE(daemon_.wait_for_log("waiting for the rest of KTLX")) << daemon_.log();
    const Bytes record = bomb_records(1);
    for (int i = 0; i < 20; ++i) {
        append_to_file(drop() / "KTLX_growing",
                       {reinterpret_cast<const char*>(record.data()), record.size()});
        std::this_thread::sleep_for(std::chrono::milliseconds{20});
    }
    for (int site = 0; site < 2; ++site) {
        const fs::path directory = drop() / "KTLX" / std::to_string(site);
        put(directory / "20220317-000842-001-S", first_record());
        for (int i = 2; i < 12; ++i) {
            const std::string number = (i < 10 ? "00" : "0") + std::to_string(i);
            put(directory / ("20220317-000842-" + number + "-I"), record);
        }
    }
    ASSERT_TRUE(daemon_.wait_for([&](const json&) { return !reason_of("KTLX_growing").empty(); }))
        << daemon_.log();
    put(drop() / "KTLX_good", volume());
    ASSERT_TRUE(wait_until_gridded("KTLX_good")) << daemon_.log();
    expect_bounded("bombs that grow or come as chunks");
    EXPECT_EQ(daemon_.terminate(), 0);
}

TEST_F(HostileDrop, BombsOfGzipAndCompressAreRejected) {
    const Bytes zeros(std::size_t{300} << 20U);
    const Bytes packed = wire::gzip(zeros);
    put(drop() / "KTLX_gzip.gz", packed);
    put(drop() / "KTLX_twice.gz", wire::gzip(packed));
    put(drop() / "KTLX_bzip2.bz2", wire::bzip2(zeros));
    put(drop() / "KTLX_compress.Z", wire::compress(zeros, 16, 0));
    for (const auto& entry : fs::directory_iterator(drop()))
        std::printf("%s: %ju bytes\n", entry.path().filename().c_str(), entry.file_size());
    begin_ = std::chrono::steady_clock::now();
    start();
    put(drop() / "KTLX_good", volume());
    ASSERT_TRUE(wait_until_gridded("KTLX_good")) << daemon_.log();
    ASSERT_TRUE(wait_until_rejected(4)) << daemon_.log();
    for (const char* name : {"KTLX_gzip.gz", "KTLX_twice.gz", "KTLX_bzip2.bz2", "KTLX_compress.Z"})
        EXPECT_NE(reason_of(name), "") << name;
    expect_bounded("bombs of gzip, bzip2 and compress");
    EXPECT_EQ(daemon_.terminate(), 0);
}

// A directory in a directory, and so on; the directory's name is "d".
void make_deep(const fs::path& top, int depth) {
    int at = ::open(top.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC);
    for (int i = 0; i < depth; ++i) {
        ASSERT_EQ(::mkdirat(at, "d", 0755), 0);
        const int below = ::openat(at, "d", O_PATH | O_DIRECTORY | O_CLOEXEC);
        ::close(at);
        at = below;
    }
    ::close(at);
}

// So deep that whoever removes it by descending runs out of descriptors.
void remove_deep(const fs::path& top) {
    while (fs::exists(top / "d/d")) {
        fs::rename(top / "d/d", top / "e");
        fs::remove(top / "d");
        fs::rename(top / "e", top / "d");
    }
    fs::remove(top / "d");
}

TEST_F(HostileDrop, DeepAndWideDirectoriesAreBounded) {
    fs::create_directory(drop() / "old");
    make_deep(drop() / "old", 10'000);
    for (int i = 0; i < 2000; ++i)
        fs::create_directories(drop() / "wide" / std::to_string(i));
    start();
    fs::create_directory(drop() / "new");
    make_deep(drop() / "new", 1'000);
    const std::string long_name(250, 'n');
    fs::path path = drop();
    for (int i = 0; i < 15; ++i)
        path /= long_name;
    fs::create_directories(path);
    const int at = ::open(path.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC);
    const int file = ::openat(at, std::string(255, 'f').c_str(), O_WRONLY | O_CREAT, 0644);
    ::close(file);
    ::close(at);
    put(drop() / "wide/1999/KTLX_good", volume());
    ASSERT_TRUE(wait_until_gridded("KTLX_good")) << daemon_.log();
    ASSERT_TRUE(was_said(": more than 16 directories deep, left out"));
    const std::uint64_t scans = daemon_.status()["scans"];
    ASSERT_TRUE(daemon_.wait_for([&](const json& s) { return s["scans"] >= scans + 2; }));
    EXPECT_LT(daemon_.status()["directories"], 2000 + 2 * 20 + 20);
    EXPECT_EQ(daemon_.status()["failures"], 0) << daemon_.log();
    expect_bounded("10,000 directories deep, 2,000 wide");
    EXPECT_EQ(daemon_.terminate(), 0);
    remove_deep(drop() / "old");
    remove_deep(drop() / "new");
}

// In a user namespace of its own, where the limits may be set: of watches and of instances.
class FewWatches : public HostileDrop {
  protected:
    // False where the system does not let us.
    bool limit(const std::string& name, int value) {
        const std::string set =
            "echo " + std::to_string(value) + " > /proc/sys/user/max_inotify_" + name;
        if (testing::run_program("/usr/bin/unshare", {"-Ur", "sh", "-c", set}).status != 0)
            return false;
        daemon_.run_under({"unshare", "-Ur", "sh", "-c", set + " && exec \"$@\"", "sh"});
        return true;
    }
    void expect_polling() {
        for (const char* name : {"a", "b", "c"}) {
            put(drop() / name / "KTLX_new", volume());
            ASSERT_TRUE(wait_until_gridded(std::string{name} + "/KTLX_new")) << daemon_.log();
        }
        EXPECT_EQ(daemon_.terminate(), 0);
    }
};

constexpr const char* polled =
    "[ingest]\nspacing_km = 4\n[watch]\nrescan_seconds = 86400\npoll_seconds = 1\n";

TEST_F(FewWatches, WithoutWatchesTheRestIsPolled) {
    if (!limit("watches", 2)) GTEST_SKIP() << "limits of watches cannot be set here";
    for (const char* name : {"a", "b", "c"})
        fs::create_directory(drop() / name);
    daemon_.start(polled);
    ASSERT_TRUE(was_said(
        "no inotify watches left; raise the sysctl user.max_inotify_watches (2 now); the drop "
        "directory is polled"));
    expect_polling();
    const std::string log = daemon_.log();
    EXPECT_EQ(log.find("no inotify watches"), log.rfind("no inotify watches")) << "said once";
}

TEST_F(FewWatches, WithoutAnInstanceEverythingIsPolled) {
    if (!limit("instances", 0)) GTEST_SKIP() << "limits of instances cannot be set here";
    daemon_.start(polled);
    ASSERT_TRUE(was_said("raise the sysctl user.max_inotify_instances (0 now)"));
    expect_polling();
}

// LDM's scour deletes what is old, whatever anybody does with it at that moment.
TEST_F(HostileDrop, FilesMayGoAtAnyMoment) {
    start();
    const Bytes bytes = volume();
    for (int i = 0; i < 150; ++i) {
        const fs::path directory = drop() / ("day" + std::to_string(i / 30));
        put(directory / ("KTLX_" + std::to_string(i)), bytes);
        std::this_thread::sleep_for(std::chrono::milliseconds{i % 7 * 3});
        if (i >= 2)
            fs::remove(drop() / ("day" + std::to_string((i - 2) / 30)) /
                       ("KTLX_" + std::to_string(i - 2)));
        if (i % 30 == 29) fs::remove_all(directory);
    }
    put(drop() / "KTLX_good", volume());
    ASSERT_TRUE(wait_until_gridded("KTLX_good")) << daemon_.log();
    const std::uint64_t scans = daemon_.status()["scans"];
    ASSERT_TRUE(daemon_.wait_for([&](const json& s) {
        return s["scans"] >= scans + 2 && s["pending"]["waiting"] == 0 &&
               s["pending"]["running"] == 0 && s["pending"]["growing"] == 0;
    })) << daemon_.log();
    EXPECT_EQ(daemon_.terminate(), 0);
    EXPECT_EQ(daemon_.status()["failures"], 0) << daemon_.log();
    EXPECT_EQ(daemon_.status()["rejected"], 0) << daemon_.log();
    auto catalog = catalog::Catalog::open_for_reading(daemon_.catalog());
    const auto entries = catalog->list("KTLX", {std::nullopt, std::nullopt, true});
    ASSERT_TRUE(entries);
    for (const catalog::CatalogEntry& entry : *entries) {
        const bool stands = fs::exists(entry.path);
        EXPECT_EQ(entry.state == catalog::FileState::gone, !stands) << entry.path;
    }
}

}  // namespace
}  // namespace stormcellar::daemon
