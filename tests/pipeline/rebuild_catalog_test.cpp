// Tests that a catalog is made again from raw files, and from the readable rows of a damaged
// catalog.
#include "pipeline/care/rebuild_catalog.h"

#include <fstream>

#include <gtest/gtest.h>

#include "catalog/check_catalog.h"
#include "pipeline/ingest/ingest.h"
#include "tests/testing/small_sequence.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::pipeline {
namespace {

using catalog::CatalogReader;
using catalog::FileState;

class RebuildCatalog : public ::testing::Test {
  protected:
    void SetUp() override {
        fs::create_directories(drop_ / "KBGM");
        options_.catalog = catalog_;
        options_.drop = drop_;
    }
    // Puts two volumes, and a file without a volume, into the drop directory.
    void fill_drop() {
        for (const std::string name : {first_, second_})
            testing::write_small_volume(name, drop_ / "KBGM" / name);
        std::ofstream(drop_ / "noise") << std::string(5000, 'x');
        std::ofstream(drop_ / ".hidden") << "not done";
    }
    std::vector<catalog::CatalogEntry> rows(const std::string& station) {
        auto catalog = *CatalogReader::open(catalog_);
        return *catalog.list(station, {{}, {}, true});
    }
    testing::TemporaryDirectory directory_;
    fs::path drop_ = directory_ / "drop";
    fs::path catalog_ = directory_ / "state/catalog";
    RebuildOptions options_;
    static constexpr const char *first_ = testing::small_sequence[0],
                                *second_ = testing::small_sequence[1];
};

TEST_F(RebuildCatalog, ADeletedCatalogComesBackFromTheDropDirectory) {
    fill_drop();
    std::size_t last = 0;
    options_.progress = [&](std::size_t done, std::size_t all) {
        EXPECT_EQ(all, 3U);
        last = done;
    };
    const auto report = rebuild_catalog(options_);
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_EQ(report->files, 3U);
    EXPECT_EQ(report->registered, 2U);
    EXPECT_EQ(report->rejected, 1U);
    EXPECT_EQ(last, 3U);
    EXPECT_TRUE(report->problems.empty());
    ASSERT_EQ(rows("KBGM").size(), 2U);
    EXPECT_EQ(rows("KBGM")[0].state, FileState::complete);
    EXPECT_EQ(rows("KBGM")[0].volume.sweep_count > 0, true);
    EXPECT_EQ(rows("").at(0).state, FileState::rejected);
    EXPECT_TRUE(catalog::check_catalog(catalog_, "")->is_sound());
    EXPECT_EQ(rebuild_catalog(options_)->unchanged, 3U)
        << "rebuilding a sound catalog should change nothing";
}

TEST_F(RebuildCatalog, ADamagedCatalogKeepsItsGoneRows) {
    fill_drop();
    ASSERT_TRUE(rebuild_catalog(options_));
    fs::remove(drop_ / "KBGM" / first_);
    ASSERT_EQ(rebuild_catalog(options_)->gone, 1);
    fs::resize_file(catalog_ / "KBGM.sqlite", fs::file_size(catalog_ / "KBGM.sqlite") - 100);
    ASSERT_FALSE(catalog::check_catalog(catalog_, "")->is_sound());

    const auto report = rebuild_catalog(options_);
    ASSERT_TRUE(report) << report.error().message;
    ASSERT_EQ(report->repairs.size(), 1U);
    EXPECT_EQ(report->repairs[0].kept_gone, 1);
    EXPECT_EQ(report->repairs[0].lost, 0);
    EXPECT_EQ(report->registered, 1U);
    ASSERT_EQ(rows("KBGM").size(), 2U);
    EXPECT_EQ(rows("KBGM")[0].state, FileState::gone);
    EXPECT_EQ(rows("KBGM")[1].state, FileState::complete);
    const auto check = catalog::check_catalog(catalog_, "");
    EXPECT_TRUE(check->is_sound());
    EXPECT_EQ(check->set_aside.size(), 1U);
}

TEST_F(RebuildCatalog, OfOneStationOnlyFilesThatMayBeItsAreRead) {
    fill_drop();
    options_.station = "KOKX";
    const auto report = rebuild_catalog(options_);
    ASSERT_TRUE(report);
    EXPECT_EQ(report->files, 1U) << "a file without a station may belong to any station";
    options_.station = "KBGM";
    EXPECT_EQ(rebuild_catalog(options_)->registered, 2U);
}

// 2026-11-24: a database that could not be opened ended the rebuilding of all other databases.
TEST_F(RebuildCatalog, ADatabaseThatCannotBeUsedIsNamedAndTheOthersAreRebuilt) {
    fill_drop();
    fs::create_directories(catalog_ / "KAAA.sqlite");
    fs::create_directories(catalog_ / "KOKX.sqlite");
    fs::copy_file(drop_ / "KBGM" / first_, drop_ / "KOKX20050822_024414_V06");
    const auto report = rebuild_catalog(options_);
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_EQ(report->registered, 2U);
    EXPECT_EQ(report->rejected, 1U);
    ASSERT_EQ(report->problems.size(), 2U) << "there should be one problem for each database";
    EXPECT_NE(report->problems[0].message.find("KAAA.sqlite"), std::string::npos);
    EXPECT_NE(report->problems[1].message.find("KOKX.sqlite"), std::string::npos);
    options_.station = "KAAA";
    EXPECT_FALSE(rebuild_catalog(options_))
        << "a bad database is an error if only its station is requested";
}

TEST_F(RebuildCatalog, OnlyStationsThatAreKnownGetADatabaseAndTheDropDirectoryIsToldToReaders) {
    fill_drop();
    options_.stations = std::make_shared<StationRule>(StationRule::listed({"KTLX"}));
    ASSERT_TRUE(rebuild_catalog(options_));
    EXPECT_FALSE(fs::exists(catalog_ / "KBGM.sqlite"));
    EXPECT_EQ(rows("").size(), 3U);
    EXPECT_EQ(*CatalogReader::open(catalog_)->drop_directory(), fs::canonical(drop_));
}

TEST_F(RebuildCatalog, AMissingDropDirectoryIsAnErrorAndMarksNothing) {
    options_.drop = directory_ / "none";
    EXPECT_EQ(rebuild_catalog(options_).error().code, ErrorCode::not_found);
}

}  // namespace
}  // namespace stormcellar::pipeline
