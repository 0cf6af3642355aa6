// Runs the real programs: a bucket offers real volumes, stormcellar-feed writes their chunks, and
// stormcellard must make the same grids from them as from chunks that LDM writes.
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/daemon/running_daemon.h"
#include "tests/fetch/feed/chunk_bucket.h"
#include "tests/testing/data.h"
#include "tests/testing/program.h"
#include "tests/testing/waiting.h"

namespace stormcellar::feed {
namespace {

namespace fs = std::filesystem;
using daemon::RunningDaemon;
using nlohmann::json;
using testing::RunningProgram;

constexpr const char* small_grids =
    "[ingest]\nspacing_km = 4\nextent_km = [400, 400]\nchunk_timeout_seconds = 8\n"
    "chunk_grace_seconds = 2\n[cache]\nbytes = \"1 GB\"\n[watch]\nrescan_seconds = 2\n";

class FeedPrograms : public ::testing::Test {
  protected:
    // Returns a set of real chunks, as objects of a directory of the bucket.
    static std::map<std::string, std::string> chunks(const std::string& set,
                                                     const std::string& directory) {
        std::map<std::string, std::string> objects;
        for (const auto& [name, contents] :
             files_below(*testing::data_directory() / "chunks" / set))
            objects[directory + name] = contents;
        return objects;
    }
    void put(const std::map<std::string, std::string>& objects) {
        for (const auto& [key, contents] : objects)
            bucket_.put(key, contents);
    }
    void start_feed(const std::string& stations) {
        const fs::path file = daemon_.root() / "feed.toml";
        std::ofstream(file) << "[paths]\ndrop = \"drop\"\n[feed]\ndrop = \"drop\"\nstate = "
                               "\"feed\"\nstations = "
                            << stations << "\nbucket = \"" << bucket_.url()
                            << "\"\nkeep_hours = 1000000\n[log]\nlevel = \"debug\"\n";
        feed_.emplace(STORMCELLAR_FEED, std::vector<std::string>{"--config", file.native()});
    }
    [[nodiscard]] bool wait_for_files(std::size_t count) const {
        return testing::eventually([&] { return files().size() >= count; });
    }
    // Returns the files without temporary files.
    [[nodiscard]] std::map<std::string, std::string> files() const {
        auto files = files_below(daemon_.drop());
        std::erase_if(files,
                      [](const auto& one) { return one.first.find("/.") != std::string::npos; });
        return files;
    }
    // Returns the grids that another daemon makes from the same chunks, written as LDM writes them;
    // empty if that daemon did not ingest all volumes.
    static std::map<std::string, std::string> grids_by_ldm(
        const std::map<std::string, std::string>& objects, int volumes) {
        RunningDaemon daemon;
        daemon.start(small_grids);
        for (const auto& [key, contents] : objects) {
            fs::create_directories((daemon.drop() / key).parent_path());
            std::ofstream(daemon.drop() / key, std::ios::binary) << contents;
        }
        return are_ingested(daemon, volumes) ? files_below(daemon.cache())
                                             : std::map<std::string, std::string>{};
    }
    static bool are_ingested(const RunningDaemon& daemon, int volumes) {
        return daemon.wait_for([&](const json& status) {
            return status["ingested"] == volumes && status["pending"]["waiting"] == 0 &&
                   status["pending"]["running"] == 0 && status["pending"]["growing"] == 0;
        });
    }

    ChunkBucket bucket_;
    RunningDaemon daemon_;
    std::optional<RunningProgram> feed_;
};

TEST_F(FeedPrograms, TheGridsAreTheBytesOfLdms) {
    STORMCELLAR_NEED_DATA();
    daemon_.start(small_grids);
    const auto without_end = chunks("KLOT_34", "KLOT/999/");
    put(without_end);
    put(chunks("L2D_185", "TORD/185/"));
    start_feed("[\"KLOT\", \"TORD\"]");
    ASSERT_TRUE(wait_for_files(without_end.size() + 49)) << feed_->err();
    put(chunks("L2D_230", "KLOT/1/"));
    put(chunks("OPENRADAR_KLOT", "KLOT/2/"));
    ASSERT_TRUE(wait_for_files(bucket_.objects().size())) << feed_->err();
    EXPECT_EQ(files(), bucket_.objects());
    ASSERT_TRUE(are_ingested(daemon_, 4)) << daemon_.log();
    EXPECT_EQ(feed_->end(SIGTERM), 0) << feed_->err();
    const auto grids = files_below(daemon_.cache());
    EXPECT_GE(grids.size(), 4U);
    EXPECT_TRUE(grids == grids_by_ldm(bucket_.objects(), 4));
}

TEST_F(FeedPrograms, KilledInTheMiddleOfAVolumeItLosesNothing) {
    STORMCELLAR_NEED_DATA();
    // The bucket holds back an answer until the feed, which waits for it, is killed.
    std::atomic<int> gets{0};
    std::atomic<bool> is_killed{true};
    bucket_.change = [&](const std::string& asked, testing::Reply reply) {
        if (asked.starts_with("GET") && ++gets % 17 == 0 && gets < 60) {
            is_killed = false;
            EXPECT_TRUE(testing::eventually([&] { return is_killed.load(); }));
        }
        return reply;
    };
    daemon_.start(small_grids);
    put(chunks("OPENRADAR_KLOT", "KLOT/901/"));
    for (int kills = 0; kills < 3; ++kills) {
        start_feed("[\"KLOT\"]");
        ASSERT_TRUE(testing::eventually([&] { return !is_killed; })) << feed_->err();
        EXPECT_LT(files().size(), bucket_.objects().size())
            << "the feed must be in the middle of the volume";
        EXPECT_EQ(feed_->end(SIGKILL), -SIGKILL);
        is_killed = true;
    }
    start_feed("[\"KLOT\"]");
    ASSERT_TRUE(wait_for_files(55)) << feed_->err();
    EXPECT_EQ(files(), bucket_.objects());
    EXPECT_LE(gets, 55 + 3) << "only chunks that had not arrived are fetched again";
    ASSERT_TRUE(are_ingested(daemon_, 1)) << daemon_.log();
    EXPECT_TRUE(files_below(daemon_.cache()) == grids_by_ldm(bucket_.objects(), 1));
}

TEST_F(FeedPrograms, AReloadFollowsOtherStations) {
    bucket_.put_volume("KTLX", 7, now_utc() - std::chrono::minutes{3}, 3);
    bucket_.put_volume("KFDR", 8, now_utc() - std::chrono::minutes{3}, 4);
    start_feed("[\"KTLX\"]");
    ASSERT_TRUE(wait_for_files(3));
    const fs::path file = daemon_.root() / "feed.toml";
    const auto rewrite = [&](const std::string& stations) {
        std::ofstream(file) << "[paths]\ndrop = \"drop\"\n[feed]\ndrop = \"drop\"\nstate = "
                               "\"feed\"\nbucket = \""
                            << bucket_.url() << "\"\nstations = " << stations << "\n";
        ASSERT_EQ(::kill(feed_->id(), SIGHUP), 0);
    };
    rewrite("[\"nonsense\"]");
    ASSERT_TRUE(testing::eventually([&] {
        return feed_->err().find("the configuration stays as it was") != std::string::npos;
    }));
    rewrite("[\"KFDR\"]");
    ASSERT_TRUE(wait_for_files(7));
    EXPECT_EQ(feed_->end(SIGTERM), 0);
}

TEST_F(FeedPrograms, TheConfigurationIsChecked) {
    const fs::path file = daemon_.root() / "feed.toml";
    std::ofstream(file) << "[feed]\nstations = []\n";
    const auto checked =
        testing::run_program(STORMCELLAR_FEED, {"--config", file.native(), "--check-config"});
    EXPECT_EQ(checked.status, 0);
    EXPECT_NE(checked.out.find(": ok"), std::string::npos);
    const auto idle = testing::run_program(STORMCELLAR_FEED, {"--config", file.native()});
    EXPECT_EQ(idle.status, 1);
    EXPECT_NE(idle.err.find("there is nothing to follow"), std::string::npos);
    EXPECT_EQ(testing::run_program(STORMCELLAR_FEED, {"--nonsense"}).status, 2);
}

}  // namespace
}  // namespace stormcellar::feed
