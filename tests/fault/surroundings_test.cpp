// Tests faults around the daemon: a full disk, no descriptors, a busy or damaged database, a drop
// directory that vanishes and comes back, too many files, lost events.
#include <chrono>
#include <csignal>
#include <cstdio>
#include <fstream>

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>
#include <sys/mount.h>
#include <sys/resource.h>

#include "tests/daemon/write_file.h"
#include "tests/fault/faulty_daemon.h"
#include "tests/fault/load.h"
#include "tests/testing/waiting.h"

namespace stormcellar::fault {
namespace {

namespace fs = std::filesystem;
using daemon::write_file;
using nlohmann::json;
using Clock = std::chrono::steady_clock;

constexpr std::initializer_list<const char*> of_space = {"No space left", "is full"};
constexpr Way ways[] = {Way::whole, Way::growing, Way::open, Way::chunks};

class Surroundings : public ::testing::Test {
  protected:
    // Delivers `volumes` volumes by the four ways in turn. With every eighth volume, it also
    // delivers junk and a real volume.
    void deliver_some(int volumes) {
        for (int i = 0; i < volumes; ++i) {
            put(shipments_.volume(ways[i % 4]));
            if (i % 8 != 7) continue;
            put(shipments_.junk());
            if (auto real = shipments_.real(ways[i / 8 % 4])) put(*real);
        }
    }
    void put(const Shipment& shipment) {
        deliver(shipment);
        delivered_.push_back(shipment.delivered);
    }
    void expect_to_catch_up(int seconds = 60) {
        began_ = Clock::now();
        EXPECT_TRUE(daemon_.catches_up(files_of(delivered_), seconds)) << daemon_.log_end();
        seconds_ = std::chrono::duration<double>(Clock::now() - began_).count();
    }
    void start_with(int volumes) {
        deliver_some(volumes);
        daemon_.start();
        expect_to_catch_up();
    }
    // Delivers volumes that the daemon cannot store. Expects that the daemon complains and goes on.
    void expect_complaints(std::initializer_list<const char*> texts) {
        deliver_some(8);
        EXPECT_TRUE(testing::eventually([&] { return complaints(texts) > 1; }))
            << daemon_.log_end();
        EXPECT_FALSE(daemon_.running().ended()) << daemon_.log_end();
    }
    Aftermath stop_and_look() {
        EXPECT_EQ(daemon_.stop(), 0) << daemon_.log_end();
        Aftermath after = look_at_aftermath(daemon_.places(), delivered_);
        EXPECT_TRUE(after.holds()) << after.problem_text() << daemon_.log_end();
        EXPECT_EQ(after.gridded, after.volumes);
        std::printf("%s: caught up %.1f s after it ended; %s\n",
                    ::testing::UnitTest::GetInstance()->current_test_info()->name(), seconds_,
                    after.summary().c_str());
        std::fflush(stdout);
        return after;
    }
    bool log_says(const std::string& text) { return daemon_.running().wait_for_log(text); }
    // Counts how often the log has one of the texts.
    std::size_t complaints(std::initializer_list<const char*> texts) {
        const std::string log = daemon_.running().log();
        std::size_t count = 0;
        for (const std::string text : texts)
            for (auto at = log.find(text); at != std::string::npos; at = log.find(text, at + 1))
                ++count;
        return count;
    }

    FaultyDaemon daemon_;
    Shipments shipments_{daemon_.drop(), 11};
    std::vector<Delivered> delivered_;
    Clock::time_point began_;
    double seconds_ = 0;
};

// A file system of its own, mounted on a directory until the object is destroyed.
class SmallDisk {
  public:
    SmallDisk(fs::path directory, const char* size) : directory_(std::move(directory)) {
        fs::create_directory(directory_);
        mounted_ = ::mount("tmpfs", directory_.c_str(), "tmpfs", 0, size) == 0;
    }
    SmallDisk(const SmallDisk&) = delete;
    SmallDisk& operator=(const SmallDisk&) = delete;
    ~SmallDisk() {
        if (mounted_) ::umount2(directory_.c_str(), MNT_DETACH);
    }
    [[nodiscard]] bool is_mounted() const { return mounted_; }
    void fill() const {
        std::ofstream file(directory_ / "ballast", std::ios::binary);
        const std::string block(4096, 'x');
        while (file.write(block.data(), 4096).flush()) {
        }
    }
    void free() const { fs::remove(directory_ / "ballast"); }

  private:
    fs::path directory_;
    bool mounted_ = false;
};

TEST_F(Surroundings, AFullDisk) {
    const fs::path root = daemon_.running().root();
    const SmallDisk disk(root / "disk", "size=24m");
    if (!disk.is_mounted()) GTEST_SKIP() << "only root may mount a tmpfs";
    for (const char* name : {"state", "cache"}) {
        fs::create_directory(root / "disk" / name);
        fs::create_directory_symlink(root / "disk" / name, root / name);
    }
    start_with(4);
    disk.fill();
    expect_complaints(of_space);
    disk.free();
    expect_to_catch_up();
    // The disk is also full at the next start.
    EXPECT_EQ(daemon_.stop(), 0) << daemon_.log_end();
    disk.fill();
    deliver_some(8);
    const std::size_t before = complaints(of_space);
    daemon_.start();
    std::optional<int> ended;
    EXPECT_TRUE(testing::eventually([&] {
        ended = daemon_.running().ended();
        return ended || complaints(of_space) > before;
    }));
    disk.free();
    if (ended || daemon_.running().ended()) daemon_.start();
    expect_to_catch_up();
    stop_and_look();
}

// Descriptors may run out because of another part of the process, or a small ulimit.
TEST_F(Surroundings, NoDescriptorsLeft) {
    start_with(2);
    rlimit before{};
    const pid_t id = daemon_.id();
    ASSERT_EQ(::prlimit(id, RLIMIT_NOFILE, nullptr, &before), 0);
    const rlimit few{3, before.rlim_max};
    ASSERT_EQ(::prlimit(id, RLIMIT_NOFILE, &few, nullptr), 0);
    expect_complaints({"Too many open files"});
    ASSERT_EQ(::prlimit(id, RLIMIT_NOFILE, &before, nullptr), 0);
    expect_to_catch_up();
    stop_and_look();
}

// The database is busy for longer than the ten seconds that a statement waits
// (catalog/station_opening.cpp).
TEST_F(Surroundings, ADatabaseThatAnotherProcessKeepsBusy) {
    start_with(6);
    {
        SQLite::Database other((daemon_.places().state / "catalog/XFAA.sqlite").native(),
                               SQLite::OPEN_READWRITE, 5000);
        other.exec("BEGIN EXCLUSIVE");
        deliver_some(8);
        EXPECT_TRUE(log_says("database is locked")) << daemon_.log_end();
        other.exec("ROLLBACK");
    }
    expect_to_catch_up();
    stop_and_look();
}

// After a clean stop, all rows are in the databases themselves, not in their write-ahead logs.
TEST_F(Surroundings, DatabasesThatAreDamagedUnderWay) {
    start_with(8);
    EXPECT_EQ(daemon_.stop(), 0) << daemon_.log_end();
    daemon_.start();
    expect_to_catch_up();
    const fs::path catalog = daemon_.places().state / "catalog";
    write_file(catalog / "XFAA.sqlite", std::string(40'000, 'x'));
    deliver_some(8);
    fs::resize_file(catalog / "XFAB.sqlite", 5000);
    fs::remove(catalog / "XFAD.sqlite");
    deliver_some(8);
    expect_to_catch_up();
    // SQLite reads the log only after a crash, and notices then that the log was overwritten.
    write_file(catalog / "XFAC.sqlite-wal", std::string(9000, 'x'));
    deliver_some(8);
    expect_to_catch_up();
    daemon_.kill();
    daemon_.start();
    expect_to_catch_up();
    const Aftermath after = stop_and_look();
    EXPECT_GT(after.set_aside, 0U);
}

TEST_F(Surroundings, ADropDirectoryThatVanishesAndReturns) {
    deliver_some(4);
    daemon_.start();
    deliver_some(4);
    const fs::path away = daemon_.running().root() / "away";
    fs::rename(daemon_.drop(), away);
    EXPECT_TRUE(log_says("; looking again every")) << daemon_.log_end();
    fs::rename(away, daemon_.drop());
    deliver_some(4);
    expect_to_catch_up();
    deliver_some(4);  // events must arrive again
    expect_to_catch_up();
    // Put another directory in place of the drop directory, and write files into the new directory.
    fs::rename(daemon_.drop(), away);
    fs::create_directory(daemon_.drop());
    const std::uint64_t scans = daemon_.running().status()["scans"];
    deliver_some(4);
    EXPECT_TRUE(daemon_.running().wait_for([&](const json& s) { return s["scans"] > scans; }));
    for (const auto& entry : fs::recursive_directory_iterator(away)) {
        const fs::path target = daemon_.drop() / fs::relative(entry.path(), away);
        if (entry.is_directory()) fs::create_directories(target);
        if (entry.is_regular_file()) fs::rename(entry.path(), target);
    }
    expect_to_catch_up();
    stop_and_look();
}

TEST_F(Surroundings, EventsThatTheKernelDropped) {
    start_with(2);
    std::ifstream limit("/proc/sys/fs/inotify/max_queued_events");
    int most = 16'384;
    limit >> most;
    daemon_.running().signal(SIGSTOP);
    const fs::path noise = daemon_.drop() / ".noise";
    for (int events = 0; events <= most; events += 4) {  // create, write, close, remove
        write_file(noise, "x");
        fs::remove(noise);
    }
    deliver_some(16);
    daemon_.running().signal(SIGCONT);
    expect_to_catch_up();
    EXPECT_TRUE(daemon_.running().wait_for([](const json& s) { return s["overflows"] > 0; }));
    stop_and_look();
}

// One rename of a directory makes many files appear. At the same time, the same number of other
// files is written, with volumes among them.
TEST_F(Surroundings, ManyFilesAtOnce) {
    const int files = number_of("STORMCELLAR_FAULT_FILES", 4000);
    const fs::path prepared = daemon_.running().root() / "prepared";
    const auto junk = [&](const fs::path& directory, int number) {
        fs::path name = std::to_string(number / 1000) + "/f" + std::to_string(number);
        fs::create_directories((directory / name).parent_path());
        write_file(directory / name, "no radar data " + std::to_string(number));
        return name;
    };
    const fs::path many = daemon_.drop() / "many";
    for (int i = 0; i < files / 2; ++i)
        delivered_.push_back({{many / junk(prepared, i)}, Contents::junk, {}, {}});
    deliver_some(16);
    daemon_.start();
    EXPECT_TRUE(daemon_.running().wait_for([](const json& s) { return s["state"] == "running"; }));
    const auto began = Clock::now();
    fs::rename(prepared, many);
    for (int i = files / 2; i < files; ++i)
        delivered_.push_back({{many / junk(many, i)}, Contents::junk, {}, {}});
    deliver_some(16);
    const double written_s = std::chrono::duration<double>(Clock::now() - began).count();
    expect_to_catch_up(1800);
    const long peak_mib = daemon_.running().peak_mib();
    std::printf("%d files, written within %.1f s: peak %ld MiB\n", files, written_s, peak_mib);
    std::fflush(stdout);
    if (!is_sanitized) {
        EXPECT_LT(peak_mib, 400);
    }
    stop_and_look();
}

}  // namespace
}  // namespace stormcellar::fault
