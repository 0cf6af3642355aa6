// Runs `stormcellar cache stat|list|evict|pin|unpin` as a user does.
#include <filesystem>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/cache/made_grids.h"
#include "tests/cli/run_stormcellar.h"
#include "tests/testing/metered_file_system.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::cli {
namespace {

using nlohmann::json;
using testing::ProgramResult;

class CacheChangeTest : public ::testing::Test {
  protected:
    CacheChangeTest() {
        const UtcTime noon = *parse_utc("2024-11-20T12:00", UtcTime{});
        for (const int hour : {0, 1, 2, 3}) {
            EXPECT_TRUE(testing::commit_sized(store_, "KBGM", noon + std::chrono::hours{hour}));
        }
        EXPECT_TRUE(testing::commit_sized(store_, "northeast", noon));
        EXPECT_TRUE(testing::commit_sized(store_, "northeast.KBOX", noon));
        grid_bytes_ = testing::all_grids(store_).front().bytes_on_disk;
    }
    ProgramResult run(const Words& arguments) {
        return cli::run(with({"cache"}, arguments, {"--cache", directory_.path()}));
    }
    json facts(const Words& arguments, int status = 0) {
        const ProgramResult ran = run(with(arguments, {"--json"}));
        EXPECT_EQ(ran.status, status) << ran.err;
        return json::parse(ran.out);
    }
    std::size_t count() { return testing::all_grids(store_).size(); }

    testing::TemporaryDirectory directory_;
    testing::MeteredFileSystem disk_{directory_.path()};
    cache::StoreWriter store_ = *cache::StoreWriter::open(disk_, directory_.path(), false);
    std::uint64_t grid_bytes_ = 0;
};

TEST_F(CacheChangeTest, StatTellsBytesPinsAndTimesOfEachDomain) {
    ASSERT_EQ(run({"pin", "--domain", "KBGM", "--to", "2024-11-20T13:00"}).status, 0);
    const json stat = facts({"stat"});
    ASSERT_EQ(stat.size(), 3U);
    EXPECT_EQ(stat[0]["domain"], "KBGM");
    EXPECT_EQ(stat[0]["grids"], 4);
    EXPECT_EQ(stat[0]["bytes"], 4 * grid_bytes_);
    EXPECT_EQ(stat[0]["pinned"], 2);
    EXPECT_EQ(stat[0]["pinned_bytes"], 2 * grid_bytes_);
    EXPECT_EQ(stat[0]["oldest"], "2024-11-20T12:00:00Z");
    EXPECT_EQ(stat[0]["latest"], "2024-11-20T15:00:00Z");
    EXPECT_EQ(stat[2]["domain"], "northeast.KBOX");
    EXPECT_EQ(facts({"list"})[1]["pinned"], true);
    EXPECT_EQ(facts({"list"})[2]["pinned"], false);
}

TEST_F(CacheChangeTest, EvictTakesWhatIsAskedForAndADryRunTakesNothing) {
    const json dry = facts({"evict", "--older-than", "1.5", "--dry-run"});
    EXPECT_EQ(dry["dry_run"], true);
    EXPECT_EQ(dry["evicted"].size(), 2U);
    EXPECT_EQ(dry["bytes"], 2 * grid_bytes_);
    EXPECT_EQ(count(), 6U);

    const json done = facts({"evict", "--older-than", "1.5"});
    EXPECT_EQ(done["evicted"], dry["evicted"]);
    EXPECT_FALSE(fs::exists(done["evicted"][0]["path"].get<std::string>()));
    EXPECT_EQ(count(), 4U);
    EXPECT_EQ(facts({"evict", "--domain", "northeast", "--to", "now"})["evicted"].size(), 2U);
    EXPECT_EQ(count(), 2U);
    EXPECT_TRUE(facts({"evict", "--bytes", "1 GB"})["evicted"].empty());
    EXPECT_EQ(facts({"evict", "--bytes", std::to_string(grid_bytes_)})["evicted"].size(), 1U);
    EXPECT_EQ(count(), 1U);
}

TEST_F(CacheChangeTest, PinnedGridsAndTheNewestStayAndThatIsSaid) {
    ASSERT_EQ(run({"pin", "--domain", "KBGM", "--to", "2024-11-20T12:00"}).status, 0);
    const json some = facts({"evict", "--domain", "KBGM", "--bytes", "0"}, 1);
    EXPECT_EQ(some["evicted"].size(), 2U);
    EXPECT_EQ(some["pinned"], 1);
    const auto ran = run({"evict", "--domain", "KBGM", "--bytes", "0"});
    EXPECT_NE(ran.err.find("remain, because these grids are pinned or the newest of their domains"),
              std::string::npos)
        << ran.err;
    EXPECT_EQ(facts({"unpin", "--domain", "KBGM"})["unpinned"].size(), 1U)
        << "only grids that were pinned are listed";
    EXPECT_EQ(run({"unpin", "--domain", "KBGM"}).status, 3) << "no grid is pinned any more";
    EXPECT_EQ(facts({"evict", "--domain", "KBGM", "--to", "now"})["evicted"].size(), 2U);
}

TEST_F(CacheChangeTest, BadUsageIsTwoAndNothingMatchedIsThree) {
    for (const Words& arguments : {Words{"evict"},
                                   {"evict", "--bytes", "much"},
                                   {"evict", "--to", "yesterday"},
                                   {"evict", "--older-than", "-1"},
                                   {"pin"}}) {
        EXPECT_EQ(run(arguments).status, 2) << arguments.back();
    }
    EXPECT_EQ(run({"evict", "--domain", "KTLX", "--to", "now"}).status, 3);
    EXPECT_EQ(run({"pin", "--domain", "KTLX"}).status, 3);
    EXPECT_EQ(run({"unpin", "--domain", "KBGM", "--from", "2027-01-01"}).status, 3);
    EXPECT_EQ(count(), 6U);
}

}  // namespace
}  // namespace stormcellar::cli
