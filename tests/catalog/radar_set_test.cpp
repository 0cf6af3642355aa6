#include "stormcellar/catalog/radar_set.h"

#include <fstream>

#include <gtest/gtest.h>

#include "base/checksum.h"
#include "stormcellar/base/file_system.h"
#include "tests/catalog/catalog_fixture.h"
#include "tests/testing/data.h"

namespace stormcellar::catalog {
namespace {

// Five real volumes of one site, which are registered in the wrong order.
class RadarSetTest : public CatalogTest {
  protected:
    void SetUp() override {
        STORMCELLAR_NEED_DATA();
        fs::create_directory(drop_);
        for (const char* name :
             {"KBGM20050822_030830.gz", "KBGM20050822_024414.gz", "KBGM20050822_030243.gz",
              "KBGM20050822_025549.gz", "KBGM20050822_025001.gz"}) {
            const auto path = drop_ / name;
            fs::copy_file(testing::real_file("sequence-kbgm") / name, path);
            const auto decoded = level2::decode_file(path);
            ASSERT_TRUE(decoded);
            const auto bytes = *read_file(path);
            FileFacts facts;
            facts.path = path;
            facts.station = decoded->volume.station;
            facts.size_bytes = bytes.size();
            facts.content_hash = xxh3_64(bytes);
            facts.state = FileState::complete;
            facts.volumes.emplace_back().start_time = decoded->volume.start_time();
            ASSERT_TRUE(catalog_.register_file(facts));
        }
    }
    fs::path drop_ = directory_ / "drop";
};

TEST_F(RadarSetTest, ListsFilesOldestFirstWithinInclusiveTimes) {
    const auto set = RadarSet::open(directory_ / "catalog", "KBGM");
    ASSERT_TRUE(set);
    EXPECT_EQ(*set->oldest_file_name(), "KBGM20050822_024414.gz");
    const auto names = set->build_data_list(at("2005-08-22T02:50:01"), at("2005-08-22T03:02:43"));
    ASSERT_TRUE(names);
    EXPECT_EQ(*names, (std::vector<std::string>{"KBGM20050822_025001.gz", "KBGM20050822_025549.gz",
                                                "KBGM20050822_030243.gz"}));
}

TEST_F(RadarSetTest, GivesRawBytesAndTheDecodedVolume) {
    const auto set = RadarSet::open(directory_ / "catalog", "KBGM");
    ASSERT_TRUE(set);
    const auto bytes = set->radar_file("KBGM20050822_024414.gz");
    ASSERT_TRUE(bytes);
    EXPECT_EQ(*bytes, *read_file(testing::real_file("sequence-kbgm/KBGM20050822_024414.gz")));
    const auto decoded = set->read_radar("KBGM20050822_024414.gz");
    ASSERT_TRUE(decoded);
    EXPECT_EQ(decoded->volume.sweeps.size(), 11U);  // golden: n_sweeps
}

// 2026-11-24: a link in the place of a file was followed, and its target was returned as the file.
TEST_F(RadarSetTest, WhatIsNotTheCatalogedFileIsNotGiven) {
    const auto set = RadarSet::open(directory_ / "catalog", "KBGM");
    ASSERT_TRUE(set);
    const std::string linked = "KBGM20050822_024414.gz", changed = "KBGM20050822_025001.gz";
    fs::rename(drop_ / linked, directory_ / "elsewhere");
    fs::create_symlink(directory_ / "elsewhere", drop_ / linked);
    fs::permissions(drop_ / changed, fs::perms::owner_write, fs::perm_options::add);
    std::fstream(drop_ / changed, std::ios::in | std::ios::out | std::ios::binary) << "other";
    for (const auto& [name, code] :
         {std::pair{linked, ErrorCode::not_a_file}, std::pair{changed, ErrorCode::corrupt}}) {
        EXPECT_EQ(set->radar_file(name).error().code, code) << name;
        EXPECT_EQ(set->read_radar(name).error().code, code) << name;
    }
    EXPECT_TRUE(set->radar_file("KBGM20050822_025549.gz"));
    fs::rename(drop_, directory_ / "moved");
    fs::create_directory_symlink(directory_ / "moved", drop_);
    EXPECT_EQ(set->radar_file("KBGM20050822_025549.gz").error().code, ErrorCode::not_found);
}

TEST_F(RadarSetTest, UnknownNamesAndStationsAreNotFound) {
    const auto set = RadarSet::open(directory_ / "catalog", "KBGM");
    ASSERT_TRUE(set);
    EXPECT_EQ(set->radar_file("KBGM20050822_999999.gz").error().code, ErrorCode::not_found);
    EXPECT_EQ(RadarSet::open(directory_ / "catalog", "KTLX").error().code, ErrorCode::not_found);
    EXPECT_EQ(RadarSet::open_all(directory_ / "catalog")->size(), 1U);
    // A station whose database cannot be opened does not affect other stations, and does not count
    // as unknown.
    fs::create_directory(directory_ / "catalog/KOUN.sqlite");
    EXPECT_EQ(RadarSet::open_all(directory_ / "catalog")->size(), 1U);
    EXPECT_TRUE(RadarSet::open(directory_ / "catalog", "KBGM"));
    EXPECT_EQ(RadarSet::open(directory_ / "catalog", "KOUN").error().code, ErrorCode::not_a_file);
}

}  // namespace
}  // namespace stormcellar::catalog
