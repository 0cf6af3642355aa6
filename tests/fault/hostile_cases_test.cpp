// Input that claims what is not its own: stations, descriptors, places in the queue, memory, room
// in the cache. Each case stopped ingest once, or took from stations that did nothing wrong;
// whatever is claimed, the stations that are known go on as before.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <sstream>
#include <thread>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/inotify.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/station_table.h"
#include "tests/daemon/write_file.h"
#include "tests/fault/faulty_daemon.h"
#include "tests/fault/hostile_files.h"
#include "tests/fault/hostile_watch.h"
#include "tests/testing/slow_down.h"

namespace stormcellar::fault {
namespace {

namespace fs = std::filesystem;
namespace wire = level2::wire;
using nlohmann::json;
using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::slow_down;

// What a good volume may wait beside an attack.
constexpr double prompt_s = 5.0 * slow_down;
constexpr double ready_s = 5.0 * slow_down;
constexpr long most_mib = 512;

// What a configuration says beyond what makes the daemon quick.
struct More {
    std::string watch = {}, ingest = {}, cache = {}, rest = {};
    int quiet_s = 2;
};

std::string configuration(const More& more) {
    return "[watch]\nrescan_seconds = 2\n" + more.watch + "[cache]\npercent = 0\n" + more.cache +
           "[ingest]\nquiet_seconds = " + std::to_string(more.quiet_s) +
           "\nreread_seconds = 0.05\nworkers = 2\nspacing_km = 10\n"
           "extent_km = [200, 200]\nlevels_km = [1, 3, 6]\n" +
           more.ingest + "[log]\nlevel = \"debug\"\n" + more.rest;
}

class HostileCases : public ::testing::Test {
  protected:
    // Gives the seconds until it was ready.
    double start(const More& more = {}) {
        const double took_s = start_until_ready(daemon_, configuration(more));
        EXPECT_LT(took_s, ready_s);
        return took_s;
    }
    // As a script does it: under a dot-name, then renamed.
    void put(const fs::path& name, const Bytes& bytes) {
        const fs::path path = daemon_.drop() / name;
        fs::create_directories(path.parent_path());
        const fs::path hidden = path.parent_path() / ("." + path.filename().native());
        daemon::write_file(hidden, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
        fs::rename(hidden, path);
    }
    // A volume that nobody could object to, of this second plus so many. Gives its time.
    UtcTime put_good(const std::string& station, int plus_s = 0, unsigned gates = 400) {
        const UtcTime time = std::chrono::floor<seconds>(now_utc()) + seconds{plus_s};
        Claims claims = claims_of(station, time);
        claims.sweeps = 2;
        claims.gates = gates;
        claims.is_varied = true;
        put(station + format_compact(time), volume_bytes(claims));
        return time;
    }
    // Seconds until it is gridded; it fails where it is not within `most_s`.
    double expect_gridded(const std::string& station, UtcTime time, double most_s = prompt_s) {
        const auto begin = std::chrono::steady_clock::now();
        const bool came =
            comes_true(most_s, [&] { return has_whole_grid(daemon_.cache(), station, time); });
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
        EXPECT_TRUE(came) << station << " has no grid after " << took.count() << " s\n"
                          << log_end();
        if (came) std::printf("%s was gridded after %.2f s\n", station.c_str(), took.count());
        return took.count();
    }
    bool rests(double most_s) { return comes_to_rest(daemon_, most_s); }
    // Lines with this text, of this severity or of any one.
    std::size_t lines_with(const std::string& text, const std::string& severity = {}) const {
        std::istringstream log(daemon_.log());
        std::size_t lines = 0;
        for (std::string line; std::getline(log, line);) {
            const bool counts = severity.empty() || line.find(" " + severity + ": ") < 30;
            lines += counts && line.find(text) != std::string::npos ? 1 : 0;
        }
        return lines;
    }
    std::size_t complaints_about(const std::string& text) const {
        return lines_with(text, "error") + lines_with(text, "warning");
    }
    std::string log_end() const {
        const std::string log = daemon_.log();
        return log.size() > 2500 ? log.substr(log.size() - 2500) : log;
    }
    void expect_no_invented_database() {
        const auto databases = databases_in(daemon_.catalog());
        EXPECT_EQ(invented_among(databases), std::set<std::string>{});
        EXPECT_TRUE(databases.contains("KTLX"));
        EXPECT_TRUE(databases.contains("_unknown"));
    }
    void stop() { EXPECT_EQ(daemon_.terminate(), 0) << log_end(); }
    // Whether rows of all these files say that they were rejected, and why.
    std::string not_rejected(const std::vector<fs::path>& names) const {
        const auto rows = catalog_rows(daemon_.catalog());
        std::string missing;
        for (const fs::path& name : names) {
            const auto [begin, end] = rows.equal_range(daemon_.drop() / name);
            const bool is_rejected = std::distance(begin, end) == 1 &&
                                     begin->second.state == "rejected" &&
                                     !begin->second.reason.empty();
            if (!is_rejected)
                missing += name.native() +
                           (begin == end ? ": no row\n" : ": " + begin->second.state + "\n");
        }
        return missing.substr(0, 500);
    }

    daemon::RunningDaemon daemon_;
};

// A file of 300 bytes that claims to be of a station.
Bytes small_claim(const std::string& station, std::size_t number) {
    Claims claims;
    claims.station = station;
    claims.time = nexrad_from_time(now_utc() - std::chrono::hours{1});
    claims.time.milliseconds += static_cast<std::uint32_t>(number);
    claims.radials = 4;
    claims.gates = 20;
    return volume_bytes(claims);
}

// ---- Case 1: stations that are invented, and descriptors
// -------------------------------------------

constexpr int few_descriptors = 512;

class InventedStations : public HostileCases {
  protected:
    // As a service manager limits it, for good.
    InventedStations() {
        const std::string limit =
            std::to_string(few_descriptors) + ":" + std::to_string(few_descriptors);
        daemon_.run_under({"prlimit", "--nofile=" + limit});
    }
    void put_invented(std::size_t count) {
        for (std::size_t i = 0; i < count; ++i)
            put(invented_station(i) + "20241003_010000", small_claim(invented_station(i), i));
    }
};

TEST_F(InventedStations, TakeNoDescriptorsAndNoDatabases) {
    start();
    put_invented(300);
    ASSERT_TRUE(rests(30 * slow_down)) << log_end();
    EXPECT_LT(open_descriptors(daemon_.id()), few_descriptors / 2);
    expect_gridded("KTLX", put_good("KTLX"));
    EXPECT_EQ(lines_with("Too many open files"), 0U);
    expect_no_invented_database();
    EXPECT_EQ(invented_among(domains_in(daemon_.cache())), std::set<std::string>{});
    stop();
    for (const auto& entry : fs::directory_iterator(daemon_.drop())) {
        if (entry.path().filename().native().starts_with('X')) fs::remove(entry.path());
    }
    start();
    expect_gridded("KTLX", put_good("KTLX", 60));
    EXPECT_LT(open_descriptors(daemon_.id()), few_descriptors / 4);
    expect_no_invented_database();
    stop();
}

// More of them than descriptors would do, if each station's database stayed open.
TEST_F(InventedStations, ClaimsOfEveryKnownStationLeaveDescriptorsForTheRest) {
    start();
    for (const Station& station : all_stations()) {
        if (station.icao == "KTLX") continue;
        put(std::string{station.icao} + "20241003_010000",
            small_claim(std::string{station.icao}, 0));
    }
    ASSERT_TRUE(rests(30 * slow_down)) << log_end();
    EXPECT_LT(open_descriptors(daemon_.id()), few_descriptors * 3 / 4);
    expect_gridded("KTLX", put_good("KTLX"));
    EXPECT_EQ(lines_with("Too many open files"), 0U);
    stop();
    start();
    expect_gridded("KTLX", put_good("KTLX", 60));
    EXPECT_LT(open_descriptors(daemon_.id()), few_descriptors * 3 / 4);
    stop();
}

// Databases that a version made which believed every name.
TEST_F(InventedStations, AStateThatAnAttackLeftIsReadyAsSoon) {
    start();
    expect_gridded("KTLX", put_good("KTLX"));
    stop();
    for (std::size_t i = 0; i < 1500; ++i)
        fs::copy_file(daemon_.catalog() / "KTLX.sqlite",
                      daemon_.catalog() / (invented_station(i) + ".sqlite"));
    const double took_s = start();
    std::printf("ready after %.2f s beside 1,500 databases of nobody\n", took_s);
    EXPECT_LT(open_descriptors(daemon_.id()), few_descriptors / 4);
    expect_gridded("KTLX", put_good("KTLX", 60));
    expect_gridded("KFWS", put_good("KFWS"));
    ASSERT_TRUE(rests(30 * slow_down)) << log_end();
    EXPECT_LT(open_descriptors(daemon_.id()), few_descriptors / 4);
    EXPECT_EQ(lines_with("Too many open files"), 0U);
    EXPECT_FALSE(daemon_.status().is_null()) << "the status could not be written";
    stop();
}

// ---- Case 12: files whose trouble is not known as the data's
// ---------------------------------------

TEST_F(HostileCases, FilesThatCannotBeGriddedAreSettledAtOnceAndFillNoQueue) {
    start({.watch = "queue_limit = 64\n"});
    const UtcTime start_time = now_utc();
    std::vector<fs::path> names;
    for (int i = 0; i < 200; ++i) {
        names.emplace_back("KTLX_bad" + std::to_string(i));
        put(names.back(), overflowing_bytes(claims_of("KTLX", start_time + milliseconds{i})));
    }
    std::this_thread::sleep_for(seconds{1});
    expect_gridded("KFWS", put_good("KFWS"));
    EXPECT_TRUE(comes_true(15 * slow_down, [&] { return not_rejected(names).empty(); }))
        << not_rejected(names);
    EXPECT_TRUE(rests(prompt_s));
    EXPECT_EQ(lines_with("trying again"), 0U) << log_end();
    EXPECT_EQ(daemon_.status()["failures"], 0);
    stop();
}

// ---- Case 5: files that grow and hold memory
// -------------------------------------------------------

class LivingMemory : public HostileCases {
  protected:
    static constexpr int files = 100;

    // Each unpacks to a sweep of 50 MB that does not end, and begins a record that does not come.
    void put_endless(const std::function<std::string(int)>& station_of) {
        for (int i = 0; i < files; ++i) {
            const std::string station = station_of(i);
            const Bytes bytes =
                wire::join({endless_bytes(claims_of(station, now_utc())), begun_record(500'000)});
            daemon::write_file(daemon_.drop() / (station + "_grow" + std::to_string(i)),
                               {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
        }
    }
    void grow_all() {
        for (const auto& entry : fs::directory_iterator(daemon_.drop())) {
            if (entry.path().native().find("_grow") != std::string::npos)
                daemon::append_to_file(entry.path(), "x");
        }
    }
    void expect_bounded() {
        const long peak = daemon_.peak_mib();
        std::printf("peak %ld MiB\n", peak);
        if (!is_sanitized) {
            EXPECT_LT(peak, most_mib);
        }
    }
};

TEST_F(LivingMemory, SweepsThatNeverEndAreCounted) {
    start();
    put_endless([](int) { return "KTLX"; });
    expect_gridded("KFWS", put_good("KFWS"), 2 * prompt_s);
    grow_all();
    expect_gridded("KTLX", put_good("KTLX"), 2 * prompt_s);
    EXPECT_TRUE(rests(60 * slow_down)) << log_end();
    expect_bounded();
    EXPECT_GT(daemon_.status()["growing_given_up"], 0);
    stop();
}

TEST_F(LivingMemory, SweepsOfManyStationsThatNeverEndAreCounted) {
    start();
    const auto stations = all_stations();
    put_endless([&](int i) { return std::string{stations[static_cast<std::size_t>(i)].icao}; });
    expect_gridded("KTLX", put_good("KTLX"), 2 * prompt_s);
    grow_all();
    expect_gridded("KFWS", put_good("KFWS"), 2 * prompt_s);
    EXPECT_TRUE(rests(60 * slow_down)) << log_end();
    expect_bounded();
    stop();
}

// The bytes of a record that has not ended: a hole, so that they cost the sender nothing.
TEST_F(LivingMemory, RecordsThatNeverEndAreCounted) {
    constexpr std::uint32_t record_bytes = 60'000'000;
    start();
    for (int i = 0; i < 30; ++i) {
        Claims claims = claims_of("KTLX", now_utc());
        const Bytes bytes =
            wire::join({endless_bytes(claims, 125, 100), begun_record(record_bytes)});
        const fs::path path = daemon_.drop() / ("KTLX_begun" + std::to_string(i));
        daemon::write_file(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
        fs::resize_file(path, bytes.size() + record_bytes - 1000);
    }
    expect_gridded("KFWS", put_good("KFWS"), 2 * prompt_s);
    EXPECT_TRUE(rests(60 * slow_down)) << log_end();
    expect_bounded();
    stop();
}

// More files and volumes of chunks than are followed, each of which begins and then stands still.
TEST_F(LivingMemory, WhatOnlyBeginsTakesNoPlaceFromWhatGoesOn) {
    start({.quiet_s = 60});
    const auto begun = [](std::string_view station) {
        Claims claims = claims_of(station, now_utc() - std::chrono::hours{1});
        claims.sweeps = 2;
        return wire::join({file_header(claims), wire::ldm_record(sweep_messages(claims, 0))});
    };
    for (int i = 0; i < 2; ++i) {
        for (const Station& station : all_stations()) {
            const std::string name{station.icao};
            put(name + "_begun" + std::to_string(i), begun(name));
            put(fs::path{name} / std::to_string(i) / "20241003-010000-001-S", begun(name));
        }
    }
    EXPECT_TRUE(rests(20 * slow_down));
    Claims growing = claims_of("KTLX", std::chrono::floor<seconds>(now_utc()));
    Claims of_chunks = claims_of("KFWS", std::chrono::floor<seconds>(now_utc()));
    growing.sweeps = of_chunks.sweeps = 3;
    for (unsigned sweep = 0; sweep < 3; ++sweep) {
        const auto record = [&](const Claims& claims) {
            const Bytes bytes = wire::ldm_record(sweep_messages(claims, sweep), sweep == 2);
            return sweep == 0 ? wire::join({file_header(claims), bytes}) : bytes;
        };
        const Bytes bytes = record(growing);
        daemon::append_to_file(daemon_.drop() / "KTLX_real",
                               {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
        const std::string kind{"SIE"[sweep]};
        put("KFWS/77/20241003-020000-00" + std::to_string(sweep + 1) + "-" + kind,
            record(of_chunks));
        std::this_thread::sleep_for(milliseconds{700});
    }
    const auto time_of = [](const Claims& claims) {
        return time_from_nexrad(claims.time.day, claims.time.milliseconds);
    };
    expect_gridded("KTLX", time_of(growing));
    expect_gridded("KFWS", time_of(of_chunks));
    stop();
}

// ---- Case 2: the newest grid of a site that nobody knows
// -------------------------------------------

class ProtectedNewest : public HostileCases {
  protected:
    static More with(const std::string& ingest) {
        return {.ingest = ingest, .cache = "bytes = \"20 MB\"\n"};
    }
    void expect_standing(const std::vector<UtcTime>& history) {
        const auto stand = std::count_if(history.begin(), history.end(), [&](UtcTime time) {
            return has_whole_grid(daemon_.cache(), "KTLX", time);
        });
        EXPECT_EQ(stand, static_cast<std::ptrdiff_t>(history.size())) << "grids of real history";
    }
    // Grids of some 300 kB each.
    void put_invented_sites(std::size_t count) {
        for (std::size_t i = 0; i < count; ++i) {
            Claims claims = invented_claims(i, now_utc() - std::chrono::hours{1});
            claims.sweeps = 4;
            claims.gates = 900;
            claims.is_varied = true;
            put(claims.station + "20241003_010000", plain_volume_bytes(claims));
        }
    }
};

// What configuration() says, but with larger grids.
constexpr const char* large_grids = "[ingest]\nquiet_seconds = 2\nworkers = 2\nspacing_km = 4\n";

TEST_F(ProtectedNewest, GridsOfInventedSitesPushOutNoRealHistory) {
    const std::string config =
        "[watch]\nrescan_seconds = 2\n[cache]\npercent = 0\nbytes = \"20 MB\"\n" +
        std::string{large_grids} + "stations = \"any\"\n";
    start_until_ready(daemon_, config);
    std::vector<UtcTime> history;
    for (int i = 0; i < 12; ++i)
        history.push_back(put_good("KTLX", -7200 + 300 * i, 900));
    for (const UtcTime time : history)
        expect_gridded("KTLX", time, 2 * prompt_s);
    put_invented_sites(110);
    ASSERT_TRUE(rests(60 * slow_down)) << log_end();
    const auto invented = invented_among(domains_in(daemon_.cache()));
    std::printf("%zu invented sites have grids\n", invented.size());
    EXPECT_LE(invented.size(), 64U);
    expect_standing(history);
    for (const char* station : {"KTLX", "KFWS", "KINX"})
        expect_gridded(station, put_good(station, 0, 1200));
    EXPECT_EQ(lines_with("no room for"), 0U);
    EXPECT_LE(disk_bytes_below(daemon_.cache()), 20'000'000U);
    expect_standing(history);
    stop();
}

TEST_F(ProtectedNewest, ByDefaultAnInventedSiteHasNoGrid) {
    start(with(""));
    put_invented_sites(20);
    expect_gridded("KTLX", put_good("KTLX"));
    ASSERT_TRUE(rests(30 * slow_down)) << log_end();
    EXPECT_EQ(invented_among(domains_in(daemon_.cache())), std::set<std::string>{});
    expect_no_invented_database();
    const auto rows = catalog_rows(daemon_.catalog());
    const auto row = rows.find(daemon_.drop() / (invented_station(7) + "20241003_010000"));
    ASSERT_NE(row, rows.end());
    EXPECT_EQ(row->second.database, "_unknown");
    stop();
}

// ---- Case 13: one database that cannot be opened
// ---------------------------------------------------

enum class Spoilt { permission, fifo, directory };

class OneDatabase : public HostileCases, public ::testing::WithParamInterface<Spoilt> {
  protected:
    // Root may open everything, so the daemon runs as somebody else.
    OneDatabase() {
        if (::geteuid() != 0) return;
        EXPECT_EQ(::chown(daemon_.root().c_str(), 65534, 65534), 0);
        daemon_.run_under({"setpriv", "--reuid=65534", "--regid=65534", "--clear-groups"});
    }
    [[nodiscard]] fs::path database() const { return daemon_.catalog() / "KTLX.sqlite"; }
    [[nodiscard]] fs::path aside() const { return daemon_.root() / "KTLX.aside"; }
    void spoil() {
        fs::rename(database(), aside());
        for (const char* beside : {"-wal", "-shm"})
            fs::remove(database().native() + beside);
        switch (GetParam()) {
            case Spoilt::permission:
                fs::copy_file(aside(), database());
                fs::permissions(database(), fs::perms::none);
                break;
            case Spoilt::fifo:
                ASSERT_EQ(::mkfifo(database().c_str(), 0666), 0);
                break;
            case Spoilt::directory:
                fs::create_directory(database());
                break;
        }
    }
    // Whatever stands there now, the database does again.
    void mend() {
        fs::remove_all(database());
        fs::copy_file(aside(), database());
        if (::geteuid() == 0) {
            ASSERT_EQ(::chown(database().c_str(), 65534, 65534), 0);
        }
        fs::permissions(database(), fs::perms{0644});
    }
};

TEST_P(OneDatabase, ThatCannotBeOpenedIsItsStationsTroubleAlone) {
    start();
    expect_gridded("KTLX", put_good("KTLX"));
    stop();
    spoil();
    const std::size_t before = complaints_about("KTLX.sqlite");
    start();
    for (const char* station : {"KFWS", "KINX", "KVNX"})
        expect_gridded(station, put_good(station));
    const UtcTime later = put_good("KTLX", 60);
    put("misc/no-radar-data", Bytes(300, std::byte{'x'}));
    EXPECT_TRUE(comes_true(prompt_s, [&] { return complaints_about("KTLX.sqlite") > before; }))
        << log_end();
    std::this_thread::sleep_for(seconds{4});
    EXPECT_EQ(complaints_about("KTLX.sqlite"), before + 1) << log_end();
    EXPECT_NE(daemon_.status().dump().find("KTLX.sqlite"), std::string::npos)
        << "the status does not name it";
    expect_gridded("KAMA", put_good("KAMA"));
    EXPECT_GT(lines_with("misc/no-radar-data ("), 0U) << "it was not rejected";
    mend();
    expect_gridded("KTLX", later, 30.0 * slow_down);
    EXPECT_EQ(daemon_.status().dump().find("KTLX.sqlite"), std::string::npos)
        << "the status still names it";
    stop();
    // Not before: whoever reads a database as root leaves files beside it that are root's.
    EXPECT_EQ(
        catalog_rows(daemon_.catalog()).count(daemon_.drop() / ("KTLX" + format_compact(later))),
        1U);
}

std::string name_of_spoilt(const ::testing::TestParamInfo<Spoilt>& which) {
    switch (which.param) {
        case Spoilt::permission:
            return "NoPermission";
        case Spoilt::fifo:
            return "Fifo";
        case Spoilt::directory:
            return "Directory";
    }
    return "";
}

INSTANTIATE_TEST_SUITE_P(HostileCases, OneDatabase,
                         ::testing::Values(Spoilt::permission, Spoilt::fifo, Spoilt::directory),
                         name_of_spoilt);

// ---- The low ones
// ----------------------------------------------------------------------------------

// How often files of some directories are opened, but for those under a dot-name. The test's own
// thread asks for what has come, often enough that the kernel loses nothing.
class Openings {
  public:
    Openings() : events_(::inotify_init1(IN_NONBLOCK | IN_CLOEXEC)) {}
    Openings(const Openings&) = delete;
    Openings& operator=(const Openings&) = delete;
    ~Openings() { ::close(events_); }

    void watch(const fs::path& directory) const {
        EXPECT_GE(::inotify_add_watch(events_, directory.c_str(), IN_OPEN), 0);
    }
    std::size_t count() {
        alignas(inotify_event) std::array<char, 65'536> buffer{};
        for (ssize_t length = 0; (length = ::read(events_, buffer.data(), buffer.size())) > 0;) {
            for (ssize_t at = 0; at < length;) {
                const auto* event = reinterpret_cast<const inotify_event*>(buffer.data() + at);
                EXPECT_EQ(event->mask & IN_Q_OVERFLOW, 0U);
                const bool is_file = event->len > 0 && (event->mask & IN_ISDIR) == 0;
                count_ += is_file && event->name[0] != '.' ? 1 : 0;
                at += static_cast<ssize_t>(sizeof(inotify_event)) + event->len;
            }
        }
        return count_;
    }

  private:
    int events_;
    std::size_t count_ = 0;
};

// More volumes of chunks than are followed at once, one chunk of each in turn.
TEST_F(HostileCases, ChunksOfManyVolumesInTurnAreNotReadAgainAndAgain) {
    constexpr int volumes = 350, chunks = 10;
    const UtcTime time = now_utc() - std::chrono::minutes{5};
    const auto directory_of = [&](int volume) { return fs::path{"KTLX"} / std::to_string(volume); };
    const auto put_chunk = [&](int volume, int chunk) {
        Claims claims = claims_of("KTLX", time + seconds{volume % 100});
        claims.radials = 90;
        claims.is_varied = true;
        Bytes bytes = wire::ldm_record(sweep_messages(claims, static_cast<unsigned>(chunk)));
        if (chunk == 0) bytes = wire::join({file_header(claims), bytes});
        const std::string name = format_compact(time + seconds{volume % 100});
        std::array<char, 40> number{};
        std::snprintf(number.data(), number.size(), "-%03d-%c", chunk + 1, chunk == 0 ? 'S' : 'I');
        put(directory_of(volume) / (name.substr(0, 8) + "-" + name.substr(9) + number.data()),
            bytes);
    };
    start();
    Openings openings;
    for (int volume = 0; volume < volumes; ++volume) {
        fs::create_directories(daemon_.drop() / directory_of(volume));
        openings.watch(daemon_.drop() / directory_of(volume));
    }
    for (int chunk = 0; chunk < chunks; ++chunk) {
        for (int volume = 0; volume < volumes; ++volume) {
            put_chunk(volume, chunk);
            openings.count();
            std::this_thread::sleep_for(milliseconds{3});  // for the daemon to look at each
        }
    }
    expect_gridded("KFWS", put_good("KFWS"), 2 * prompt_s);
    comes_true(30 * slow_down, [&] {
        openings.count();
        const json now = daemon_.status();
        return !now.is_null() && now["pending"]["waiting"] == 0 && now["pending"]["growing"] == 0;
    });
    const std::size_t opened = openings.count();
    std::printf("%d chunks, opened %zu times\n", volumes * chunks, opened);
    EXPECT_GT(opened, static_cast<std::size_t>(volumes * chunks) / 2)
        << "they were not seen at all";
    EXPECT_LT(opened, static_cast<std::size_t>(3 * volumes * chunks));
    stop();
}

TEST_F(HostileCases, AVolumeOfDateZeroHasNoGridOf1970) {
    start();
    Claims claims = claims_of("KTLX", now_utc());
    claims.time = {0, 3'600'000};
    put("KTLX_zero", volume_bytes(claims));
    put("KTLX_plain_zero", plain_volume_bytes(claims));
    expect_gridded("KTLX", put_good("KTLX"));
    ASSERT_TRUE(rests(10 * slow_down)) << log_end();
    std::set<std::string> days;
    for (const auto& entry : fs::directory_iterator(daemon_.cache() / "KTLX/REF"))
        days.insert(entry.path().filename().native());
    for (const std::string& day : days)
        EXPECT_GE(day, "2020") << "a grid of a day without radars";
    stop();
}

TEST_F(HostileCases, AnInventedStationInsideAMosaicDoesNotEnterIt) {
    start({.rest = "[[domain]]\nname = \"plains\"\ncenter = [35, -97]\nspacing_km = 10\n"
                   "extent_km = [300, 300]\nlevels_km = [1, 3]\n"});
    Claims claims = claims_of("KTLX", now_utc());
    claims.station = "XAAA";
    claims.is_varied = true;
    put("XAAA" + format_compact(now_utc()), volume_bytes(claims));
    expect_gridded("KTLX", put_good("KTLX"));
    EXPECT_TRUE(rests(10 * slow_down)) << log_end();
    EXPECT_TRUE(domains_in(daemon_.cache()).contains("plains.KTLX")) << log_end();
    EXPECT_FALSE(domains_in(daemon_.cache()).contains("plains.XAAA"));
    EXPECT_FALSE(domains_in(daemon_.cache()).contains("XAAA"));
    stop();
}

// A file that names no station at first, or another one, and grows into one of nobody.
TEST_F(HostileCases, AnInventedStationHasNoLivingGridEither) {
    start();
    Claims claims = claims_of("KTLX", now_utc());
    claims.station = "XAAA";
    claims.sweeps = 3;
    claims.is_varied = true;
    Claims nameless = claims;
    nameless.station = "    ";
    const Bytes sweep = wire::ldm_record(sweep_messages(claims, 0));
    const auto append = [&](const std::string& name, const Bytes& bytes) {
        daemon::append_to_file(daemon_.drop() / name,
                               {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    };
    append("nameless", file_header(nameless));
    append("KTLX_other", Bytes{});
    fs::create_directories(daemon_.drop() / "KTLX/7");
    const std::string chunk = "KTLX/7/20241003-010000-00";
    append(chunk + "1-S", wire::join({file_header(nameless), sweep}));
    std::this_thread::sleep_for(milliseconds{500});
    append("nameless", sweep);
    append("KTLX_other", wire::join({file_header(claims), sweep}));
    append(chunk + "2-I", wire::ldm_record(sweep_messages(claims, 1)));
    for (const char* name : {"nameless", "KTLX_other"}) {
        std::this_thread::sleep_for(milliseconds{500});
        append(name, wire::ldm_record(sweep_messages(claims, 1)));
    }
    expect_gridded("KTLX", put_good("KTLX"));
    EXPECT_TRUE(rests(15 * slow_down)) << log_end();
    EXPECT_EQ(invented_among(domains_in(daemon_.cache())), std::set<std::string>{});
    EXPECT_EQ(invented_among(databases_in(daemon_.catalog())), std::set<std::string>{});
    stop();
}

}  // namespace
}  // namespace stormcellar::fault
