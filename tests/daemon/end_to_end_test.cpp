// Runs the real program on real files. However a file arrives, it must end up in the catalog and
// the cache.
#include <algorithm>
#include <csignal>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "stormcellar/base/file_system.h"
#include "stormcellar/cache/store.h"
#include "stormcellar/catalog/catalog.h"
#include "stormcellar/grid/brick_grid.h"
#include "stormcellar/grid/column_geometry.h"
#include "stormcellar/grid/gridder.h"
#include "stormcellar/level2/decode.h"
#include "tests/daemon/notify_socket.h"
#include "tests/daemon/running_daemon.h"
#include "tests/daemon/write_file.h"
#include "tests/repository/text_of.h"
#include "tests/testing/data.h"
#include "tests/testing/metered_file_system.h"
#include "tests/testing/program.h"
#include "tests/testing/waiting.h"

namespace stormcellar::daemon {
namespace {

namespace fs = std::filesystem;
using catalog::FileState;
using nlohmann::json;

std::vector<fs::path> sorted_files(const fs::path& directory) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(directory))
        files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

bool everything_is_done(const json& status) {
    return status["pending"]["waiting"] == 0 && status["pending"]["running"] == 0 &&
           status["pending"]["growing"] == 0;
}

// Expects that every grid below the cache passes its checksums. Returns the number of grids.
std::size_t verified_grids(const fs::path& cache) {
    std::size_t grids = 0;
    for (const auto& entry : fs::recursive_directory_iterator(cache)) {
        if (!entry.is_regular_file()) continue;
        EXPECT_EQ(entry.path().extension(), ".scg") << entry.path() << " was left behind";
        const auto grid = cache::GridFile::open(entry.path());
        EXPECT_TRUE(grid) << (grid ? "" : grid.error().message);
        if (!grid) continue;
        const Status verified = grid->verify();
        EXPECT_TRUE(verified) << (verified ? "" : verified.error().message);
        ++grids;
    }
    return grids;
}

std::vector<catalog::CatalogEntry> rows(const RunningDaemon& daemon, const std::string& station) {
    auto catalog = catalog::CatalogReader::open(daemon.catalog());
    if (!catalog) return {};
    auto entries = catalog->list(station, {.from = {}, .to = {}, .with_rejected = true});
    return entries ? *entries : std::vector<catalog::CatalogEntry>{};
}

// Writes a file as LDM does with -close: opens the file, appends and closes it again for each
// piece.
void append_in_pieces(const fs::path& path, const std::string& text, std::size_t pieces) {
    const std::size_t size = text.size() / pieces + 1;
    for (std::size_t at = 0; at < text.size(); at += size) {
        append_to_file(path, text.substr(at, size));
        testing::pass_time(std::chrono::milliseconds{150});
    }
}

constexpr const char* quick = "[ingest]\nquiet_seconds = 2\n";

// Starts the service with one volume of KBGM, named "a", in its drop directory.
void take_in_one_volume(RunningDaemon& daemon) {
    fs::copy_file(*testing::data_directory() / "sequence-kbgm/KBGM20050822_024414.gz",
                  daemon.drop() / "a");
    daemon.start(quick);
    ASSERT_TRUE(daemon.wait_for([](const json& s) {
        return s["ingested"] == 1 && everything_is_done(s);
    })) << daemon.log();
}

// Grids the file without the daemon, as `stormcellar grid` does. Returns the grid with the
// precision that a cache stores.
grid::BrickGrid gridded_alone(const fs::path& raw, level2::Moment moment) {
    level2::DecodeOptions options;
    options.selection.moments = {moment};
    const auto volume = level2::decode(*read_file(raw), options)->volume;
    const auto antenna = level2::antenna_position(volume);
    const grid::SitePosition site{volume.station, antenna->latitude_deg, antenna->longitude_deg,
                                  antenna->altitude_m};
    const auto geometry =
        grid::make_column_geometry(site, grid::default_spec(site.latitude_deg, site.longitude_deg));
    grid::GridderOptions gridder;
    gridder.moment = moment;
    return grid::BrickGrid::from(*grid::make_grid(volume, site, **geometry, gridder),
                                 grid::default_quantization(moment));
}

TEST(EndToEnd, AllMomentsOfAVolumeComeOutOfOneDecoding) {
    STORMCELLAR_NEED_DATA();
    RunningDaemon daemon;
    const fs::path raw = *testing::data_directory() / "volumes/KLOT20220317_000842_V06";
    fs::copy_file(raw, daemon.drop() / raw.filename());
    daemon.start(
        "[ingest]\nquiet_seconds = 2\n"
        "moments = [\"REF\", \"VEL\", \"SW\", \"ZDR\", \"PHI\", \"RHO\"]\n");
    ASSERT_TRUE(daemon.wait_for([](const json& s) {
        return s["ingested"] == 1 && everything_is_done(s) && !s["volumes"].empty();
    })) << daemon.log();
    EXPECT_EQ(rows(daemon, "KLOT").size(), 1U);
    const json status = daemon.status();
    EXPECT_EQ(status["grids"], 6) << status.dump(1);
    EXPECT_EQ(status["volumes"].size(), 1U) << "the volume must be ingested once";
    EXPECT_EQ(verified_grids(daemon.cache()), 6U);
    const auto store = cache::StoreReader::open(daemon.cache());
    ASSERT_TRUE(store);
    for (const level2::Moment moment : level2::all_moments) {
        const auto entries = store->list("KLOT", moment, std::nullopt, std::nullopt);
        const bool is_named = moment != level2::Moment::cfp && !level2::facts_of(moment).is_derived;
        ASSERT_EQ(entries->size(), is_named ? 1U : 0U) << level2::moment_name(moment);
        if (entries->empty()) continue;
        const auto file = cache::GridFile::open(entries->front().path);
        ASSERT_TRUE(file);
        const grid::BrickGrid expected = gridded_alone(raw, moment);
        EXPECT_TRUE(std::ranges::equal(file->view().codes, expected.view().codes))
            << level2::moment_name(moment);
        EXPECT_TRUE(std::ranges::equal(file->view().states, expected.view().states))
            << level2::moment_name(moment);
    }
}

TEST(EndToEnd, EveryWayOfWritingEndsInTheCatalogAndTheCache) {
    STORMCELLAR_NEED_DATA();
    const std::vector<fs::path> volumes =
        sorted_files(*testing::data_directory() / "sequence-kbgm");
    ASSERT_EQ(volumes.size(), 5U);
    RunningDaemon daemon;
    const fs::path day = daemon.drop() / "20050822";
    // Deliver a volume before the start, and files that are not volumes.
    fs::copy_file(volumes[0], daemon.drop() / volumes[0].filename());
    write_file(daemon.drop() / "garbage", std::string(5000, 'x'));
    write_file(daemon.drop() / "empty", "");
    write_file(daemon.drop() / "two\nlines", "not radar");
    fs::create_directory(daemon.drop() / "KBGM20050822_999999.gz");
    daemon.start("[ingest]\nquiet_seconds = 5\n");  // a busy machine pauses between the pieces
    ASSERT_TRUE(daemon.wait_for([](const json& s) { return s["state"] == "running"; }));
    // Deliver volumes whole, into a new directory, renamed from a dot-file, and piece by piece.
    fs::copy_file(volumes[1], daemon.drop() / volumes[1].filename());
    fs::create_directory(day);
    fs::copy_file(volumes[2], day / volumes[2].filename());
    fs::copy_file(volumes[3], day / ".growing");
    fs::rename(day / ".growing", day / volumes[3].filename());
    append_in_pieces(day / volumes[4].filename(), testing::text_of(volumes[4]), 6);
    ASSERT_TRUE(daemon.wait_for([](const json& s) {
        return s["ingested"] == 5 && s["rejected"] >= 3 && everything_is_done(s);
    })) << daemon.status().dump(1)
        << daemon.log();
    EXPECT_EQ(daemon.terminate(), 0) << daemon.log();

    const std::vector<catalog::CatalogEntry> kbgm = rows(daemon, "KBGM");
    ASSERT_EQ(kbgm.size(), 5U) << daemon.log();
    std::set<std::string> starts;
    for (const auto& row : kbgm) {
        EXPECT_EQ(row.state, FileState::complete) << row.path << ": " << row.reason;
        starts.insert(format_compact(row.volume.start_time.value()));
    }
    EXPECT_EQ(starts,
              (std::set<std::string>{"20050822_024414", "20050822_025001", "20050822_025549",
                                     "20050822_030243", "20050822_030830"}));
    std::set<std::string> rejected;
    for (const auto& row : rows(daemon, "")) {
        EXPECT_EQ(row.state, FileState::rejected);
        EXPECT_FALSE(row.reason.empty());
        rejected.insert(row.path.filename());
    }
    EXPECT_EQ(rejected, (std::set<std::string>{"garbage", "empty", "two\nlines"}));
    EXPECT_EQ(verified_grids(daemon.cache()), 5U);

    const json status = daemon.status();
    EXPECT_EQ(status["state"], "stopped");
    // The close of a file is unknown if a scan finds the file, at the start or in a directory that
    // is not watched yet.
    EXPECT_GE(status["latency_s"]["count"], 1);
    EXPECT_LE(status["latency_s"]["count"], 4) << "the first volume was there before the start";
    EXPECT_GT(status["latency_s"]["max"], 0);
    EXPECT_NE(daemon.log().find("two\\x0alines"), std::string::npos)
        << "the newline in a name must be escaped";
    // The service does not change raw files.
    EXPECT_EQ(testing::text_of(day / volumes[4].filename()), testing::text_of(volumes[4]));
}

TEST(EndToEnd, AVolumeThatNeverEndsIsGriddedWhenItWasQuiet) {
    STORMCELLAR_NEED_DATA();
    std::string text;
    for (const fs::path& chunk : sorted_files(*testing::data_directory() / "chunks/KLOT_34"))
        text += testing::text_of(chunk);
    RunningDaemon daemon;
    daemon.start(quick);
    ASSERT_TRUE(daemon.wait_for([](const json& s) { return s["state"] == "running"; }));
    write_file(daemon.drop() / "KLOT20201019_054806", text);
    ASSERT_TRUE(daemon.wait_for([](const json& s) { return s["pending"]["growing"] == 1; }));
    EXPECT_EQ(daemon.status()["ingested"], 0) << "the volume may not be complete yet";
    ASSERT_TRUE(daemon.wait_for([](const json& s) {
        return s["ingested"] == 1 && everything_is_done(s);
    })) << daemon.log();
    EXPECT_EQ(daemon.terminate(), 0);
    const auto klot = rows(daemon, "KLOT");
    ASSERT_EQ(klot.size(), 1U);
    EXPECT_EQ(klot[0].state, FileState::partial);
    EXPECT_EQ(verified_grids(daemon.cache()), 1U);
}

TEST(EndToEnd, ASecondStartDoesNothingAgainAndTakesWhatCameMeanwhile) {
    STORMCELLAR_NEED_DATA();
    const std::vector<fs::path> volumes =
        sorted_files(*testing::data_directory() / "sequence-kbgm");
    RunningDaemon daemon;
    fs::copy_file(volumes[0], daemon.drop() / "a");
    daemon.start(quick);
    ASSERT_TRUE(daemon.wait_for([](const json& s) {
        return s["ingested"] == 1 && everything_is_done(s);
    })) << daemon.log();
    EXPECT_EQ(daemon.terminate(), 0);
    fs::copy_file(volumes[1], daemon.drop() / "b");
    fs::remove(daemon.root() / "state/status.json");
    daemon.start(quick);
    ASSERT_TRUE(daemon.wait_for([](const json& s) {
        return s["ingested"] == 1 && s["unchanged"] == 1 && everything_is_done(s);
    })) << daemon.log();
    EXPECT_EQ(daemon.terminate(), 0);
    EXPECT_EQ(rows(daemon, "KBGM").size(), 2U);
    EXPECT_EQ(verified_grids(daemon.cache()), 2U);
}

TEST(EndToEnd, ARawFileThatIsDeletedStaysInTheCatalogAsGone) {
    STORMCELLAR_NEED_DATA();
    RunningDaemon daemon;
    take_in_one_volume(daemon);
    fs::remove(daemon.drop() / "a");
    ASSERT_TRUE(daemon.wait_for([](const json& s) { return s["vanished"] == 1; }));
    EXPECT_EQ(daemon.terminate(), 0);
    const auto kbgm = rows(daemon, "KBGM");
    ASSERT_EQ(kbgm.size(), 1U);
    EXPECT_EQ(kbgm[0].state, FileState::gone);
    EXPECT_EQ(verified_grids(daemon.cache()), 1U) << "the grid must stay";
}

TEST(EndToEnd, ARawFileThatWentWhileTheServiceWasStoppedIsGoneToo) {
    STORMCELLAR_NEED_DATA();
    RunningDaemon daemon;
    take_in_one_volume(daemon);
    EXPECT_EQ(daemon.terminate(), 0);
    fs::remove(daemon.drop() / "a");
    daemon.start(quick);
    ASSERT_TRUE(daemon.wait_for_log("marked 1 file as gone")) << daemon.log();
    EXPECT_EQ(daemon.terminate(), 0);
    EXPECT_EQ(rows(daemon, "KBGM").at(0).state, FileState::gone);

    // With gone_days, the row is deleted, because it is older than a tenth of a second.
    daemon.start(std::string{quick} + "[catalog]\ngone_days = 1e-6\n");
    ASSERT_TRUE(
        daemon.wait_for_log("deleted the catalog rows of 1 file marked as gone: they were older"))
        << daemon.log();
    EXPECT_EQ(daemon.terminate(), 0);
    EXPECT_TRUE(rows(daemon, "KBGM").empty());
    EXPECT_EQ(verified_grids(daemon.cache()), 1U) << "the grid must stay";
}

TEST(EndToEnd, ANameThatIsNoTextDoesNotEndTheService) {
    STORMCELLAR_NEED_DATA();
    const std::vector<fs::path> volumes =
        sorted_files(*testing::data_directory() / "sequence-kbgm");
    RunningDaemon daemon;
    daemon.start(quick);
    ASSERT_TRUE(daemon.wait_for([](const json& s) { return s["state"] == "running"; }));
    fs::copy_file(volumes[0], daemon.drop() / "bad\xED\xA0\x80name");
    ASSERT_TRUE(daemon.wait_for([](const json& s) {
        return s["ingested"] == 1 && everything_is_done(s);
    })) << daemon.log();
    const std::string file = daemon.status()["volumes"][0]["file"];
    EXPECT_TRUE(file.ends_with("/bad\\xed\\xa0\\x80name")) << file;
    EXPECT_EQ(daemon.terminate(), 0);
}

TEST(EndToEnd, TellsTheServiceManagerWhatItDoes) {
    RunningDaemon daemon;
    NotifySocket socket(daemon.root() / "notify");
    daemon.start("[log]\nlevel = \"debug\"\n",
                 {{"NOTIFY_SOCKET", socket.path()}, {"WATCHDOG_USEC", "400000"}});
    EXPECT_TRUE(socket.hears("STATUS=ingested 0"));
    EXPECT_TRUE(socket.hears("READY=1"));
    EXPECT_TRUE(socket.hears("WATCHDOG=1"));
    daemon.expect_reload_and_end(socket);
}

TEST(EndToEnd, AReloadTakesWhatCanChangeAndSaysWhatCannot) {
    RunningDaemon daemon;
    daemon.start("[ingest]\nworkers = 1\n");
    ASSERT_TRUE(daemon.wait_for_log("ready: watching"));
    const fs::path file = daemon.root() / "stormcellard.toml";
    write_file(file,
               "[paths]\ndrop = \"drop\"\nstate = \"state\"\ncache = \"other\"\n"
               "[ingest]\nworkers = 3\n");
    daemon.signal(SIGHUP);
    EXPECT_TRUE(daemon.wait_for_log("reloaded: the configuration now has 3 workers"));
    EXPECT_TRUE(daemon.wait_for_log("the change of [paths] to take effect"));
    write_file(file,
               "[paths]\ndrop = \"drop\"\nstate = \"state\"\ncache = \"cache\"\n"
               "[ingest]\nworkers = 2\n[catalog]\nbytes = \"8 GB\"\n");
    daemon.signal(SIGHUP);
    EXPECT_TRUE(daemon.wait_for_log("[catalog] bytes and [[station]] to take effect"));
    write_file(file, "[paths]\ndorp = \"drop\"\n");
    daemon.signal(SIGHUP);
    EXPECT_TRUE(daemon.wait_for_log("the service keeps its previous configuration"));
    EXPECT_EQ(daemon.terminate(), 0) << "a bad file does not end the daemon";
}

// A reload lowers the budget: the oldest grids must go, and the newest must stay.
TEST(EndToEnd, TheCacheRollsWithinItsBudget) {
    STORMCELLAR_NEED_DATA();
    RunningDaemon daemon;
    for (const fs::path& volume : sorted_files(*testing::data_directory() / "sequence-kbgm"))
        fs::copy_file(volume, daemon.drop() / volume.filename());
    const std::string grid = "[ingest]\nspacing_km = 4\n";
    daemon.start(grid + "[cache]\nbytes = \"1 GB\"\n");
    ASSERT_TRUE(daemon.wait_for([](const json& s) {
        return s["ingested"] == 5 && everything_is_done(s) && s["rolling"].is_object() &&
               s["rolling"]["grids"] == 5;
    })) << daemon.status().dump(1);
    const json before = daemon.status()["rolling"];
    EXPECT_EQ(before["budget_bytes"], 1'000'000'000);
    EXPECT_EQ(before["evicted"], 0);
    EXPECT_EQ(before["bytes"], testing::allocated_bytes(daemon.cache()));

    const std::uint64_t budget = before["bytes"].get<std::uint64_t>() * 7 / 10;
    write_file(daemon.root() / "stormcellard.toml",
               "[paths]\ndrop = \"drop\"\nstate = \"state\"\ncache = \"cache\"\n" + grid +
                   fmt::format("[cache]\nbytes = {}\n", budget));
    daemon.signal(SIGHUP);
    ASSERT_TRUE(daemon.wait_for([](const json& s) { return s["rolling"]["evicted"] > 0; }))
        << daemon.log();
    EXPECT_LE(testing::allocated_bytes(daemon.cache()), budget);
    EXPECT_EQ(daemon.terminate(), 0) << daemon.log();
    EXPECT_NE(daemon.log().find("cache: "), std::string::npos);
    const auto store = *cache::StoreReader::open(daemon.cache());
    const auto grids = *store.list("KBGM", level2::Moment::ref, std::nullopt, std::nullopt);
    ASSERT_FALSE(grids.empty());
    EXPECT_LT(grids.size(), 5U);
    EXPECT_EQ(format_compact(grids.back().time), "20050822_030830");
}

TEST(EndToEnd, SpeaksToTheJournalWithLevelsAndWithoutTimes) {
    RunningDaemon daemon;
    write_file(daemon.root() / "log", "");
    struct stat facts {};
    ASSERT_EQ(::stat((daemon.root() / "log").c_str(), &facts), 0);
    daemon.start({}, {{"JOURNAL_STREAM", fmt::format("{}:{}", facts.st_dev, facts.st_ino)}});
    EXPECT_TRUE(daemon.wait_for_log("<6>ready: watching"));
    EXPECT_EQ(daemon.terminate(), 0);
    std::istringstream lines(daemon.log());
    for (std::string line; std::getline(lines, line);)
        EXPECT_TRUE(line.starts_with("<6>")) << line;
}

TEST(EndToEnd, OneDaemonAStateDirectory) {
    RunningDaemon daemon;
    daemon.start();
    ASSERT_TRUE(daemon.wait_for_log("ready: watching"));
    const auto second = testing::run_program(
        STORMCELLARD, {"--config", (daemon.root() / "stormcellard.toml").native()});
    EXPECT_EQ(second.status, 1);
    EXPECT_NE(second.err.find("another stormcellard (process "), std::string::npos) << second.err;
    EXPECT_EQ(daemon.terminate(), 0);
}

// The service can never open such a socket, so it does not announce a retry.
TEST(EndToEnd, ASocketPathThatIsTooLongIsSaid) {
    RunningDaemon daemon;
    daemon.start({}, {{"RUNTIME_DIRECTORY", (daemon.root() / std::string(120, 's')).native()}});
    EXPECT_TRUE(daemon.wait_for_log(
        ": the path of a socket must have 1 to 107 bytes; name another [status] "
        "socket and restart"))
        << daemon.log();
    EXPECT_EQ(daemon.log().find("trying again"), std::string::npos);
    EXPECT_EQ(daemon.terminate(), 0);
}

TEST(EndToEnd, EndsInPeaceWhenInterrupted) {
    RunningDaemon daemon;
    daemon.start();
    ASSERT_TRUE(daemon.wait_for_log("ready: watching"));
    daemon.signal(SIGINT);
    EXPECT_EQ(daemon.wait(), 0);
}

// The drop directory may appear late, for example if it is mounted late.
TEST(EndToEnd, WaitsForADropDirectoryThatIsNotThereYet) {
    STORMCELLAR_NEED_DATA();
    const std::vector<fs::path> volumes =
        sorted_files(*testing::data_directory() / "sequence-kbgm");
    RunningDaemon daemon;
    fs::remove(daemon.drop());
    daemon.start("[watch]\nrescan_seconds = 60\n");
    EXPECT_TRUE(daemon.wait_for_log("cannot read the drop directory " + daemon.drop().native() +
                                    ": No such file or directory; looking again every second"));
    ASSERT_TRUE(daemon.wait_for([](const json& s) { return s["drop_lost"].is_string(); }));
    EXPECT_TRUE(daemon.wait_for([](const json& s) { return s["state"] == "running"; }));
    fs::create_directory(daemon.drop());
    fs::copy_file(volumes[0], daemon.drop() / "a");
    ASSERT_TRUE(daemon.wait_for([](const json& s) {
        return s["drop_lost"].is_null() && s["ingested"] == 1;
    })) << daemon.log();
    EXPECT_TRUE(
        daemon.wait_for_log("the drop directory " + daemon.drop().native() + " can be read again"));
    EXPECT_EQ(daemon.terminate(), 0);
}

}  // namespace
}  // namespace stormcellar::daemon
