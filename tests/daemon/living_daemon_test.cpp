// Runs the real program on growing files, and checks the cache while the antenna still climbs.
#include <csignal>
#include <cstdio>
#include <memory>

#include <gtest/gtest.h>

#include "stormcellar/base/file_system.h"
#include "stormcellar/cache/grid_file.h"
#include "stormcellar/cache/store.h"
#include "synth/replay_pieces.h"
#include "tests/daemon/running_daemon.h"
#include "tests/testing/data.h"
#include "tests/testing/waiting.h"

namespace stormcellar::daemon {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// A file that is written to and not closed, as LDM's pqact writes without -close.
class OpenFile {
  public:
    explicit OpenFile(const fs::path& path) : file_(std::fopen(path.c_str(), "ab"), &std::fclose) {}
    void append(std::span<const std::byte> bytes) {
        std::fwrite(bytes.data(), 1, bytes.size(), file_.get());
        std::fflush(file_.get());
    }

  private:
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
};

constexpr const char* patient = "[ingest]\nquiet_seconds = 60\n";

class LivingDaemon : public ::testing::Test {
  protected:
    void SetUp() override {
        STORMCELLAR_NEED_DATA();
        bytes_ = *read_file(*testing::data_directory() / "volumes/KLOT20220317_000842_V06");
        ends_ = synth::piece_ends(bytes_);
        ASSERT_GT(ends_.size(), 30U);
    }
    std::span<const std::byte> pieces(std::size_t from, std::size_t to) const {
        const std::size_t start = from == 0 ? 0 : ends_[from - 1];
        return std::span{bytes_}.subspan(start, ends_[to - 1] - start);
    }
    // Starts the daemon and then begins an empty file.
    OpenFile start_with_file() {
        daemon_.start(patient);
        EXPECT_TRUE(daemon_.wait_for([](const json& s) { return s["state"] == "running"; }));
        return OpenFile(daemon_.drop() / "KLOT20220317_000842_V06");
    }
    // Returns the newest grid of KLOT, if there is one.
    std::optional<cache::GridDescription> newest() const {
        const auto store = cache::StoreReader::open(daemon_.cache());
        if (!store) return std::nullopt;
        const auto grids = store->list("KLOT", level2::Moment::ref, std::nullopt, std::nullopt);
        if (!grids || grids->empty()) return std::nullopt;
        const auto file = cache::GridFile::open(grids->back().path);
        if (!file) return std::nullopt;
        return file->description();
    }
    bool wait_for_grid(const std::function<bool(const cache::GridDescription&)>& is_so) const {
        return testing::eventually([&] {
            const auto grid = newest();
            return grid && is_so(*grid);
        });
    }
    static bool is_living(const cache::GridDescription& grid) {
        const auto& notes = grid.provenance.notes;
        return grid.provenance.partial && !notes.empty() && notes.back().starts_with("living: ");
    }
    // Expects that no temporary file is left, whatever happened to the program.
    void expect_nothing_left_behind() const {
        for (const fs::path& directory : {daemon_.root() / "state", daemon_.cache()}) {
            for (const auto& entry : fs::recursive_directory_iterator(directory)) {
                EXPECT_FALSE(entry.path().filename().native().starts_with(temporary_prefix))
                    << entry.path();
            }
        }
    }
    std::vector<std::byte> bytes_;
    std::vector<std::size_t> ends_;
    RunningDaemon daemon_;
};

TEST_F(LivingDaemon, SweepsAreInTheCacheWhileTheFileIsStillOpen) {
    OpenFile file = start_with_file();
    file.append(pieces(0, 12));
    ASSERT_TRUE(wait_for_grid(is_living)) << daemon_.log();
    // The daemon sees writes once it follows the file, after the first job has ended.
    ASSERT_TRUE(daemon_.wait_for([](const json& s) { return s["living_grids"] > 0; }));
    const std::size_t sweeps = newest()->provenance.sweeps.size();
    file.append(pieces(12, 40));
    ASSERT_TRUE(wait_for_grid([&](const cache::GridDescription& grid) {
        return is_living(grid) && grid.provenance.sweeps.size() > sweeps;
    })) << daemon_.log();
    EXPECT_EQ(daemon_.status()["ingested"], 0);
    // The status counts living grids before the first volume is gridded.
    EXPECT_TRUE(daemon_.wait_for([](const json& s) {
        const auto& stations = s["stations"];
        return stations.size() == 1 && s["sweep_latency_s"]["count"] > 0 &&
               stations[0]["living_grids"] == s["living_grids"] &&
               stations[0]["sweep_latency_s"]["max"] > 0 && stations[0]["data_age_s"].is_number();
    })) << daemon_.status().dump(1);
    file.append(pieces(40, ends_.size()));
    ASSERT_TRUE(wait_for_grid([](const cache::GridDescription& grid) {
        return !grid.provenance.partial && grid.provenance.notes.empty();
    })) << daemon_.log();
    EXPECT_EQ(daemon_.terminate(), 0);
    expect_nothing_left_behind();
}

TEST_F(LivingDaemon, FilesOfOneChunkEachBecomeAVolume) {
    daemon_.start(patient);
    ASSERT_TRUE(daemon_.wait_for([](const json& s) { return s["state"] == "running"; }));
    const fs::path directory = daemon_.drop() / "KLOT/494";
    fs::create_directories(directory);
    for (std::size_t i = 0; i < ends_.size(); ++i) {
        // pqact names chunks without leading zeros.
        const std::string kind = i == 0 ? "S" : i + 1 == ends_.size() ? "E" : "I";
        OpenFile(directory / ("20220317-000842-" + std::to_string(i + 1) + "-" + kind))
            .append(pieces(i, i + 1));
        if (i == 20) {
            ASSERT_TRUE(wait_for_grid(is_living)) << daemon_.log();
        }
    }
    ASSERT_TRUE(wait_for_grid([](const cache::GridDescription& grid) {
        return !grid.provenance.partial;
    })) << daemon_.log();
    ASSERT_TRUE(daemon_.wait_for([](const json& s) { return s["ingested"] == 1; }));
    EXPECT_EQ(daemon_.terminate(), 0);
    EXPECT_EQ(daemon_.status()["rejected"], 0) << daemon_.log();
    expect_nothing_left_behind();
}

TEST_F(LivingDaemon, AKilledDaemonGoesOnWithWhatHasGrown) {
    OpenFile file = start_with_file();
    file.append(pieces(0, 20));
    ASSERT_TRUE(wait_for_grid(is_living)) << daemon_.log();
    daemon_.signal(SIGKILL);
    EXPECT_EQ(daemon_.wait(), -SIGKILL);
    expect_nothing_left_behind();
    file.append(pieces(20, 45));
    const std::size_t sweeps = newest()->provenance.sweeps.size();
    daemon_.start(patient);
    ASSERT_TRUE(wait_for_grid([&](const cache::GridDescription& grid) {
        return is_living(grid) && grid.provenance.sweeps.size() > sweeps;
    })) << daemon_.log();
    file.append(pieces(45, ends_.size()));
    ASSERT_TRUE(wait_for_grid([](const cache::GridDescription& grid) {
        return !grid.provenance.partial;
    })) << daemon_.log();
    EXPECT_EQ(daemon_.terminate(), 0);
    expect_nothing_left_behind();
}

}  // namespace
}  // namespace stormcellar::daemon
