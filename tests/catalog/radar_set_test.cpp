#include "catalog/radar_set.h"

#include <gtest/gtest.h>

#include "base/file_system.h"
#include "tests/testing/data.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::catalog {
namespace {

// The five real volumes of one site, registered in the wrong order.
class RadarSetTest : public ::testing::Test {
  protected:
    void SetUp() override {
        STORMCELLAR_NEED_DATA();
        auto catalog = Catalog::open_for_writing(directory_.path());
        ASSERT_TRUE(catalog);
        for (const char* name :
             {"KBGM20050822_030830.gz", "KBGM20050822_024414.gz", "KBGM20050822_030243.gz",
              "KBGM20050822_025549.gz", "KBGM20050822_025001.gz"}) {
            const auto path = *testing::data_directory() / "sequence-kbgm" / name;
            const auto decoded = level2::decode_file(path);
            ASSERT_TRUE(decoded);
            FileFacts facts;
            facts.path = path;
            facts.station = decoded->volume.station;
            facts.state = FileState::complete;
            facts.volumes.emplace_back().start_time = decoded->volume.start_time();
            ASSERT_TRUE(catalog->register_file(facts));
        }
    }
    testing::TemporaryDirectory directory_;
};

TEST_F(RadarSetTest, ListsFilesOldestFirstWithinInclusiveTimes) {
    const auto set = RadarSet::open(directory_.path(), "KBGM");
    ASSERT_TRUE(set);
    EXPECT_EQ(*set->oldest_file_name(), "KBGM20050822_024414.gz");
    const auto names = set->build_data_list(*parse_utc("2005-08-22T02:50:01", UtcTime{}),
                                            *parse_utc("2005-08-22T03:02:43", UtcTime{}));
    ASSERT_TRUE(names);
    EXPECT_EQ(*names, (std::vector<std::string>{"KBGM20050822_025001.gz", "KBGM20050822_025549.gz",
                                                "KBGM20050822_030243.gz"}));
}

TEST_F(RadarSetTest, GivesRawBytesAndTheDecodedVolume) {
    const auto set = RadarSet::open(directory_.path(), "KBGM");
    ASSERT_TRUE(set);
    const auto bytes = set->radar_file("KBGM20050822_024414.gz");
    ASSERT_TRUE(bytes);
    EXPECT_EQ(*bytes,
              *read_file(*testing::data_directory() / "sequence-kbgm" / "KBGM20050822_024414.gz"));
    const auto decoded = set->read_radar("KBGM20050822_024414.gz");
    ASSERT_TRUE(decoded);
    EXPECT_EQ(decoded->volume.sweeps.size(), 11U);  // golden: n_sweeps
}

TEST_F(RadarSetTest, UnknownNamesAndStationsAreNotFound) {
    const auto set = RadarSet::open(directory_.path(), "KBGM");
    ASSERT_TRUE(set);
    EXPECT_EQ(set->radar_file("KBGM20050822_999999.gz").error().code, ErrorCode::not_found);
    EXPECT_EQ(RadarSet::open(directory_.path(), "KTLX").error().code, ErrorCode::not_found);
    EXPECT_EQ(RadarSet::open_all(directory_.path())->size(), 1U);
}

}  // namespace
}  // namespace stormcellar::catalog
