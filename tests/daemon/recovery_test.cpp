// Runs the real program after damage. It must restore a database, grids and a whole cache.
#include <chrono>
#include <csignal>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "stormcellar/cache/store.h"
#include "stormcellar/catalog/catalog.h"
#include "tests/daemon/running_daemon.h"
#include "tests/daemon/write_file.h"
#include "tests/testing/data.h"
#include "tests/testing/small_sequence.h"
#include "tests/testing/waiting.h"

namespace stormcellar::daemon {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

class Recovery : public ::testing::Test {
  protected:
    void put(const std::string& name) { testing::write_small_volume(name, daemon_.drop() / name); }
    void run_until_ingested(int files) {
        fs::remove(daemon_.root() / "state/status.json");
        daemon_.start("[ingest]\nquiet_seconds = 2\nspacing_km = 4\n");
        ASSERT_TRUE(daemon_.wait_for([&](const json& s) {
            return s["ingested"] == files && s["pending"]["waiting"] == 0 &&
                   s["pending"]["running"] == 0;
        })) << daemon_.log();
    }
    std::vector<cache::StoreEntry> grids() {
        const auto store = cache::StoreReader::open(daemon_.cache());
        return *store->list("KBGM", level2::Moment::ref, std::nullopt, std::nullopt);
    }
    std::vector<catalog::CatalogEntry> rows() {
        auto catalog = *catalog::CatalogReader::open(daemon_.catalog());
        return *catalog.list("KBGM", {});
    }
    static constexpr const char* first = testing::small_sequence[0];
    static constexpr const char* second = testing::small_sequence[1];
    RunningDaemon daemon_;
};

TEST_F(Recovery, ADamagedDatabaseIsSetAsideAtTheStartAndFilledAgain) {
    put(first);
    put(second);
    run_until_ingested(2);
    EXPECT_EQ(daemon_.terminate(), 0);
    fs::remove(daemon_.drop() / first);  // only the damaged database has its row
    fs::resize_file(daemon_.catalog() / "KBGM.sqlite",
                    fs::file_size(daemon_.catalog() / "KBGM.sqlite") - 100);
    run_until_ingested(1);
    EXPECT_TRUE(daemon_.wait_for_log("KBGM.sqlite: was damaged (")) << daemon_.log();
    EXPECT_EQ(daemon_.terminate(), 0);
    ASSERT_EQ(rows().size(), 2U) << daemon_.log();
    EXPECT_EQ(rows()[0].state, catalog::FileState::gone);
    EXPECT_EQ(rows()[1].state, catalog::FileState::complete);
}

TEST_F(Recovery, ADatabaseDamagedAtRunTimeDoesNotStopItsStation) {
    put(first);
    run_until_ingested(1);
    EXPECT_EQ(daemon_.terminate(), 0);
    fs::remove(daemon_.root() / "state/status.json");
    daemon_.start("[ingest]\nspacing_km = 4\n");
    ASSERT_TRUE(daemon_.wait_for([](const json& s) { return s["unchanged"] == 1; }));
    write_file(daemon_.catalog() / "KBGM.sqlite", std::string(40'000, 'x'));
    put(second);
    ASSERT_TRUE(daemon_.wait_for([](const json& s) { return s["ingested"] == 2; }))
        << "the second volume, and the first volume once more\n"
        << daemon_.log();
    EXPECT_EQ(daemon_.terminate(), 0);
    EXPECT_EQ(rows().size(), 2U);
    EXPECT_NE(daemon_.log().find("KBGM.sqlite: was damaged ("), std::string::npos) << daemon_.log();
}

TEST_F(Recovery, ADeletedDatabaseIsFilledAgain) {
    put(first);
    run_until_ingested(1);
    for (const char* name : {"KBGM.sqlite", "KBGM.sqlite-wal", "KBGM.sqlite-shm"})
        fs::remove(daemon_.catalog() / name);
    put(second);
    ASSERT_TRUE(daemon_.wait_for([](const json& s) { return s["ingested"] == 3; }))
        << daemon_.log();
    EXPECT_EQ(daemon_.terminate(), 0);
    EXPECT_EQ(rows().size(), 2U);
}

// 2026-11-22: after somebody deleted the state directory, nothing could be stored until a restart.
TEST_F(Recovery, ADeletedStateDirectoryIsMadeAgain) {
    put(first);
    run_until_ingested(1);
    fs::remove_all(daemon_.root() / "state");
    put(second);
    ASSERT_TRUE(daemon_.wait_for([](const json& s) { return s["ingested"] == 3; }))
        << daemon_.log();
    EXPECT_TRUE(daemon_.wait_for_log("state directory " + (daemon_.root() / "state").native() +
                                     " was deleted; the service made it again"));
    EXPECT_TRUE(fs::exists(daemon_.root() / "state/stormcellard.lock"));
    const fs::path socket = daemon_.root() / "state/status.sock";
    EXPECT_TRUE(testing::eventually([&] { return fs::is_socket(socket); }));
    EXPECT_EQ(daemon_.terminate(), 0);
    EXPECT_EQ(rows().size(), 2U);
}

TEST_F(Recovery, AWipedCacheAndADamagedGridAreMadeAgainAtTheStart) {
    put(first);
    put(second);
    run_until_ingested(2);
    EXPECT_EQ(daemon_.terminate(), 0);
    ASSERT_EQ(grids().size(), 2U);
    fs::resize_file(grids()[0].path, 10'000);
    daemon_.start("[ingest]\nspacing_km = 4\n");
    EXPECT_TRUE(daemon_.wait_for_log("the service removed it and made it again from"))
        << daemon_.log();
    EXPECT_EQ(daemon_.terminate(), 0);
    fs::remove_all(daemon_.cache() / "KBGM");
    daemon_.start("[ingest]\nspacing_km = 4\n");
    EXPECT_TRUE(daemon_.wait_for_log("missing grid KBGM 2005-08-22T02:44:14")) << daemon_.log();
    EXPECT_EQ(daemon_.terminate(), 0);
    ASSERT_EQ(grids().size(), 2U);
    for (const auto& grid : grids()) {
        const auto file = cache::GridFile::open(grid.path);
        ASSERT_TRUE(file) << file.error().message;
        EXPECT_TRUE(file->verify());
    }
}

// Damages a partial and a frame of a mosaic of one site, then deletes both.
TEST_F(Recovery, MosaicsAreMadeAgainFromRawFilesAndPartials) {
    const std::string domain =
        "[ingest]\nspacing_km = 4\n[[domain]]\nname = \"north\"\ncenter = [42.2, -75.9]\n"
        "spacing_km = 4\nextent_km = [400, 400]\nlevels_km = [1, 3, 6]\n";
    const auto list = [&](const std::string& name) {
        const auto store = cache::StoreReader::open(daemon_.cache());
        return *store->list(name, level2::Moment::ref, std::nullopt, std::nullopt);
    };
    put(first);
    put(second);
    daemon_.start(domain);
    ASSERT_TRUE(daemon_.wait_for([](const json& s) { return s["ingested"] == 2; }));
    EXPECT_EQ(daemon_.terminate(), 0);
    ASSERT_EQ(list("north").size(), 1U);
    ASSERT_EQ(list("north.KBGM").size(), 2U);

    fs::resize_file(list("north").at(0).path, 5000);
    fs::resize_file(list("north.KBGM").at(1).path, 5000);
    daemon_.start(domain);
    EXPECT_TRUE(
        daemon_.wait_for_log("the service removed it and made it again from the partials of KBGM"))
        << daemon_.log();
    EXPECT_TRUE(daemon_.wait_for_log(std::string{"the service removed it and made it again from "} +
                                     (daemon_.drop() / second).native()))
        << daemon_.log();
    EXPECT_EQ(daemon_.terminate(), 0);

    fs::remove_all(daemon_.cache() / "north");
    daemon_.start(domain);
    EXPECT_TRUE(daemon_.wait_for_log("missing frame north 2005-08-22T02:50:00Z was made again"))
        << daemon_.log();
    EXPECT_EQ(daemon_.terminate(), 0);
    fs::remove_all(daemon_.cache() / "north");
    fs::remove_all(daemon_.cache() / "north.KBGM");
    fs::remove(daemon_.drop() / first);
    daemon_.start(domain);
    EXPECT_TRUE(daemon_.wait_for_log("missing grid north.KBGM 2005-08-22T02:50:01"))
        << daemon_.log();
    EXPECT_EQ(daemon_.terminate(), 0);
    for (const char* name : {"north", "north.KBGM"}) {
        for (const auto& entry : list(name)) {
            const auto file = cache::GridFile::open(entry.path);
            ASSERT_TRUE(file) << file.error().message;
            EXPECT_TRUE(file->verify());
        }
    }
    EXPECT_EQ(list("north.KBGM").size(), 1U) << "the first volume's raw file is gone";
}

// If nothing is left from which a damaged grid can be made again, the service drops the grid, and
// the log says why.
TEST_F(Recovery, AMosaicThatNobodyConfiguresAnyMoreIsDroppedWithTheReason) {
    put(first);
    put(second);
    daemon_.start(
        "[ingest]\nspacing_km = 4\n[[domain]]\nname = \"north\"\ncenter = [42.2, -75.9]\n"
        "spacing_km = 8\nextent_km = [400, 400]\nlevels_km = [1, 3, 6]\n");
    ASSERT_TRUE(daemon_.wait_for([](const json& s) { return s["ingested"] == 2; }));
    EXPECT_EQ(daemon_.terminate(), 0);
    const auto store = cache::StoreReader::open(daemon_.cache());
    const auto frames = *store->list("north", level2::Moment::ref, std::nullopt, std::nullopt);
    ASSERT_EQ(frames.size(), 1U);
    fs::resize_file(frames[0].path, 5000);
    daemon_.start("[ingest]\nspacing_km = 4\n");
    EXPECT_TRUE(
        daemon_.wait_for_log("cannot make it again: the configuration no longer has REF of north"))
        << daemon_.log();
    EXPECT_EQ(daemon_.terminate(), 0);
    EXPECT_FALSE(fs::exists(frames[0].path));
}

TEST_F(Recovery, WithoutRefillAMissingGridStaysMissing) {
    put(first);
    put(second);
    run_until_ingested(2);
    EXPECT_EQ(daemon_.terminate(), 0);
    const auto made = grids();
    ASSERT_EQ(made.size(), 2U);
    fs::remove(made[0].path);
    // A round finds damage to values only after it has made missing grids.
    std::fstream file(made[1].path, std::ios::in | std::ios::out | std::ios::binary);
    const auto at = static_cast<std::streamoff>(fs::file_size(made[1].path) / 4 * 3);
    const int byte = file.seekg(at).get();
    file.seekp(at).put(static_cast<char>(byte ^ 1));
    file.close();
    daemon_.start(
        "[ingest]\nspacing_km = 4\n[cache]\nrefill_hours = 0\n[log]\nlevel = \"debug\"\n");
    EXPECT_TRUE(daemon_.wait_for_log("unchanged "));
    EXPECT_TRUE(daemon_.wait_for_log("damaged grid ")) << daemon_.log();
    EXPECT_EQ(daemon_.terminate(), 0);
    EXPECT_FALSE(fs::exists(made[0].path));
}

// Kills the program again and again while it ingests volumes. Every grid in the cache must be whole
// at any time, and in the end all grids must exist.
TEST_F(Recovery, KilledWhileItWorks) {
    STORMCELLAR_NEED_DATA();  // simulated volumes take too little time
    const fs::path sequence = *testing::data_directory() / "sequence-kbgm";
    for (const auto& volume : fs::directory_iterator(sequence))
        fs::copy_file(volume, daemon_.drop() / volume.path().filename());
    std::size_t whole = 0;
    for (int kills = 0; kills < 8; ++kills) {
        daemon_.start("[ingest]\nspacing_km = 2\n");
        testing::pass_time(std::chrono::milliseconds{40 + 60 * kills});
        daemon_.signal(SIGKILL);
        EXPECT_EQ(daemon_.wait(), -SIGKILL);
        if (!fs::exists(daemon_.cache())) continue;
        whole = 0;
        for (const auto& grid : grids()) {
            const auto file = cache::GridFile::open(grid.path);
            ASSERT_TRUE(file) << file.error().message;
            EXPECT_TRUE(file->verify());
            ++whole;
        }
    }
    // Remove the last status of the killed daemon, so that the test waits for a new status.
    fs::remove(daemon_.cache().parent_path() / "state" / "status.json");
    daemon_.start("[ingest]\nspacing_km = 2\n");
    ASSERT_TRUE(daemon_.wait_for([](const json& s) {
        return s["state"] == "running" && s["pending"]["waiting"] == 0 &&
               s["pending"]["running"] == 0 && s["pending"]["growing"] == 0;
    }));
    EXPECT_EQ(daemon_.terminate(), 0);
    EXPECT_EQ(grids().size(), 5U) << whole << " after the last kill";
    EXPECT_EQ(rows().size(), 5U);
    for (const auto& row : rows())
        EXPECT_EQ(row.state, catalog::FileState::complete) << row.path;
    EXPECT_EQ(daemon_.log().find("damaged"), std::string::npos) << daemon_.log();
    for (const auto& entry : fs::recursive_directory_iterator(daemon_.cache()))
        EXPECT_TRUE(entry.is_directory() || entry.path().extension() == ".scg") << entry.path();
}

}  // namespace
}  // namespace stormcellar::daemon
