// Makes nowcasts of real volumes and of a cache. Tests that echo without a known motion is refused.
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cli/picture/nowcast_grids.h"
#include "stormcellar/base/utc_time.h"
#include "tests/cli/files_and_service.h"
#include "tests/cli/uniform_grid.h"

namespace stormcellar::cli {
namespace {

using ::testing::HasSubstr;

class NowcastCommand : public FilesAndService {
  protected:
    [[nodiscard]] std::string sequence(const std::string& time) const {
        return (data_ / "sequence-kbgm" / ("KBGM20050822_" + time + ".gz")).native();
    }
    [[nodiscard]] Words whole_sequence() const {
        return {"nowcast",          sequence("024414"), sequence("025001"),
                sequence("025549"), sequence("030243"), sequence("030830")};
    }
    // Returns the message that refuses a nowcast with these arguments.
    [[nodiscard]] static std::string refusal_of(Words words) {
        words.insert(words.begin(), "nowcast");
        const auto refused = run(words);
        EXPECT_NE(refused.status, 0);
        EXPECT_EQ(refused.out, "");
        return refused.err;
    }
};

TEST_F(NowcastCommand, BeatsPersistenceAtEachLeadOfARealSequence) {
    Words words = whole_sequence();
    words.emplace_back("--json");
    const auto json = json_of(run(words));
    EXPECT_EQ(json["grids"], 5);
    EXPECT_EQ(json["latest"], "2005-08-22T03:08:30Z");
    ASSERT_EQ(json["leads"].size(), 12U);
    int scored = 0;
    for (const auto& lead : json["leads"]) {
        if (lead["hindcasts"] == 0) continue;
        ++scored;
        const auto &ours = lead["nowcast"], &still = lead["persistence"];
        EXPECT_LT(ours["mean_absolute_db"].get<double>(), still["mean_absolute_db"].get<double>());
        EXPECT_GT(ours["csi_20_dbz"].get<double>(), still["csi_20_dbz"].get<double>());
        EXPECT_GT(ours["csi_35_dbz"].get<double>(), still["csi_35_dbz"].get<double>());
    }
    // Six hindcasts, of 6 to 19 minutes.
    EXPECT_GE(scored, 3);
    EXPECT_EQ(json["leads"][11]["hindcasts"], 0);
    EXPECT_EQ(json["leads"][11]["time"], "2005-08-22T04:08:30Z");
}

TEST_F(NowcastCommand, WritesPicturesAndGridsThatSayWhatTheyAre) {
    Words words = whole_sequence();
    for (const char* word : {"--minutes", "12,45", "--product", "composite", "--width", "640",
                             "--height", "480", "-o"})
        words.emplace_back(word);
    words.push_back(out("soon.png"));
    const auto drawn = run(words);
    EXPECT_EQ(drawn.status, 0) << drawn.err;
    EXPECT_TRUE(fs::exists(out("soon-12.png")));
    EXPECT_TRUE(fs::exists(out("soon-45.png")));
    EXPECT_THAT(drawn.out, HasSubstr("error unknown"));  // of 45 minutes

    Words grid = whole_sequence();
    for (const char* word : {"--minutes", "12", "-o"})
        grid.emplace_back(word);
    grid.push_back(out("soon.nc"));
    EXPECT_EQ(run(grid).status, 0);
    std::ifstream file(out("soon.nc"), std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(file)), {});
    EXPECT_TRUE(bytes.find("nowcast, 12 minutes, by advection") != bytes.npos);
    EXPECT_TRUE(bytes.find("error of the nowcast: measured on ") != bytes.npos);
}

TEST_F(NowcastCommand, UsesNothingThatIsLaterThanItsTime) {
    const auto until_the_third = json_of(
        run({"nowcast", sequence("024414"), sequence("025001"), sequence("025549"), "--json"}));
    Words words = whole_sequence();
    words.insert(words.end(), {"--time", "2005-08-22T02:56:00Z", "--json"});
    EXPECT_EQ(json_of(run(words)), until_the_third);
}

TEST_F(NowcastCommand, RefusesFilesWithoutAKnownMotion) {
    EXPECT_THAT(refusal_of({sequence("024414")}), HasSubstr("two volumes or more"));
    EXPECT_THAT(refusal_of({sequence("024414"), volume("KTLX19990503_235621.gz")}),
                HasSubstr("volumes of one radar"));
    EXPECT_THAT(refusal_of({sequence("024414"), sequence("030830"), "--minutes", "90"}),
                HasSubstr("not 90"));
    EXPECT_THAT(refusal_of({sequence("024414"), sequence("030830"), "--minutes", "soon"}),
                HasSubstr("--minutes takes numbers"));
    EXPECT_THAT(refusal_of({sequence("024414"), sequence("030830"), "--product", "ppi"}),
                HasSubstr("a grid of reflectivity"));
    EXPECT_THAT(refusal_of({sequence("024414"), sequence("030830"), "--moment", "VEL"}),
                HasSubstr("a grid of reflectivity"));
    EXPECT_THAT(refusal_of({sequence("024414"), sequence("030830"), "--time", "2001-01-01"}),
                HasSubstr("no volume begins by"));
}

TEST_F(NowcastCommand, RefusesADomainWithoutAKnownMotion) {
    auto store = cache::StoreWriter::open(real_file_system(), out("cache"), false);
    ASSERT_TRUE(store);
    const auto of_cache = [&] { return refusal_of({"KBGM", "--cache", out("cache")}); };
    testing::commit_grid(*store, testing::uniform_grid("20050822_024400", 30));
    EXPECT_THAT(of_cache(), HasSubstr("two volumes or more"));
    testing::commit_grid(*store, testing::uniform_grid("20050822_031500", 30));
    EXPECT_THAT(of_cache(), HasSubstr("a gap of 31 minutes"));
    testing::commit_grid(*store, testing::uniform_grid("20050822_030000", 30));
    // Uniform echo has no pattern whose motion shows.
    EXPECT_THAT(of_cache(), HasSubstr("the motion is unknown"));
    testing::commit_grid(*store, testing::uniform_grid("20050822_032000", 30, 60));
    EXPECT_THAT(of_cache(), HasSubstr("the same area and cells"));
}

TEST(NowcastDescription, ShiftsAllTimesAndForgetsHowCellsWereMeasured) {
    cache::GridDescription latest;
    latest.time = UtcTime{std::chrono::minutes{100}};
    latest.start_time = latest.time;
    latest.end_time = latest.time + std::chrono::minutes{5};
    latest.provenance.recipe = 7;
    latest.provenance.sweeps.resize(3);
    latest.provenance.notes = {"a note"};
    const auto nowcast = describe_nowcast(latest, 7.5, "error unknown");
    EXPECT_EQ(nowcast.time, latest.time + std::chrono::seconds{450});
    EXPECT_EQ(nowcast.end_time, latest.end_time + std::chrono::seconds{450});
    EXPECT_EQ(nowcast.provenance.recipe, 0U);
    EXPECT_TRUE(nowcast.provenance.sweeps.empty());
    EXPECT_THAT(nowcast.provenance.notes,
                ::testing::ElementsAre("a note", "nowcast, 7.5 minutes, by advection",
                                       "error of the nowcast: error unknown"));
}

}  // namespace
}  // namespace stormcellar::cli
