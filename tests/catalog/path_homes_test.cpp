// Tests that a file's row is searched in few databases, but in every database that may have the
// row. A stray is a row in the database of another station than the station in the file's name.
#include "catalog/path_homes.h"

#include <gtest/gtest.h>

#include "tests/catalog/catalog_fixture.h"

namespace stormcellar::catalog {
namespace {

TEST(GuessedHome, IsTheStationOfTheNameOrOfTheTwoDirectoriesAbove) {
    EXPECT_EQ(guessed_home("/d/KTLX20220317_000000_V06"), "KTLX");
    EXPECT_EQ(guessed_home("/d/KTLX/20220317"), "KTLX");
    EXPECT_EQ(guessed_home("/d/KTLX/123/20220317-000000-001-S"), "KTLX");
    EXPECT_EQ(guessed_home("/d/KTLX/KOUN/123/chunk"), "KOUN");
    EXPECT_EQ(guessed_home("/KTLX/d/123/chunk"), unknown_station);
    EXPECT_EQ(guessed_home("/d/KTLXES/chunk"), unknown_station);
    EXPECT_EQ(guessed_home("chunk"), unknown_station);
    EXPECT_EQ(guessed_home("KTLX"), "KTLX");
    EXPECT_EQ(guessed_home(""), unknown_station);
}

// Asks for more paths than are remembered, so that earlier paths are forgotten.
void forget_homes(const CatalogReader& catalog) {
    for (int path = 0; path < 70'000; ++path)
        ASSERT_FALSE(*catalog.is_known("/other/" + std::to_string(path)));
}

TEST_F(CatalogTest, AFileThatIsNamedLikeAnotherStationIsFoundByWhoeverWroteIt) {
    ASSERT_TRUE(catalog_.register_file(file("/d/KOUN_a", {}, "KOUN")));
    ASSERT_TRUE(catalog_.register_file(file("/d/KTLX_a", {}, "KTLX")));
    EXPECT_FALSE(*catalog_.is_known("/d/b"))
        << "all databases were searched, and no database has a stray";
    ASSERT_TRUE(catalog_.register_file(file("/d/KOUN_b", {}, "KTLX")));
    ASSERT_TRUE(catalog_.register_files("KTLX", {file("/d/KOUN_c", {}, "KTLX")}));
    forget_homes(catalog_);
    for (const char* path : {"/d/KOUN_a", "/d/KTLX_a", "/d/KOUN_b", "/d/KOUN_c"})
        EXPECT_TRUE(*catalog_.is_settled(path, 1000, 42)) << path;

    // Registering KOUN_b for KOUN deletes its row in the database of KTLX.
    catalog_ = *CatalogWriter::open(directory_ / "catalog");
    ASSERT_TRUE(catalog_.register_file(file("/d/KOUN_b", {}, "KOUN")));
    EXPECT_EQ(catalog_.list("KTLX", {{}, {}, true})->size(), 2U);
    EXPECT_EQ(catalog_.list("KOUN", {{}, {}, true})->size(), 2U);
    catalog_ = *CatalogWriter::open(directory_ / "catalog");
    EXPECT_EQ(*catalog_.mark_gone("/d/KOUN_c"), 1);
}

// Asking all databases took most of the time that a new file needed.
TEST_F(CatalogTest, NoOtherDatabaseIsAskedForANewFileHoweverManyHaveStrays) {
    ASSERT_TRUE(catalog_.register_file(file("/d/KOUN_a", {}, "KOUN")));
    ASSERT_TRUE(catalog_.register_file(file("/d/KOUN_b", {}, "KTLX")));
    for (const bool is_opened_again : {false, true}) {
        SCOPED_TRACE(is_opened_again);
        if (is_opened_again) catalog_ = *CatalogWriter::open(directory_ / "catalog");
        EXPECT_FALSE(*catalog_.is_known("/d/KOUN_c"));
        // A request to this database would notice that its file was replaced.
        const fs::path database = directory_ / "catalog/KTLX.sqlite";
        fs::copy_file(database, directory_ / "copy");
        fs::rename(directory_ / "copy", database);
        EXPECT_FALSE(*catalog_.is_known("/d/KOUN_d"));
        EXPECT_EQ(*catalog_.mark_gone("/d/KOUN_e"), 0);
        EXPECT_TRUE(catalog_.take_repairs().empty());
        EXPECT_TRUE(*catalog_.is_known("/d/KOUN_b"));
    }
}

TEST_F(CatalogTest, AFileThatIsNamedLikeAnotherStationIsFoundAfterARestart) {
    ASSERT_TRUE(catalog_.register_file(file("/d/KOUN_b", {}, "KTLX")));
    ASSERT_TRUE(catalog_.register_file(file("/d/KOUN_c", {}, "")));
    catalog_ = *CatalogWriter::open(directory_ / "catalog");
    EXPECT_TRUE(*catalog_.is_known("/d/KOUN_b"));
    EXPECT_TRUE(*catalog_.is_known("/d/KOUN_c"));
    EXPECT_FALSE(*catalog_.is_known("/d/KOUN_d"));
}

// Only mark_missing() searches a database with this many rows for strays.
TEST_F(CatalogTest, AFileThatIsNamedLikeAnotherStationIsFoundInALargeDatabase) {
    std::vector<FileFacts> files;
    for (int k = 0; k < 10'001; ++k)
        files.push_back(file("/d/KTLX_" + std::to_string(k), {}));
    files.push_back(file("/d/KOUN_b", {}));
    ASSERT_TRUE(catalog_.register_files("KTLX", files));
    for (const bool is_looked_through : {false, true}) {
        SCOPED_TRACE(is_looked_through);
        catalog_ = *CatalogWriter::open(directory_ / "catalog");
        if (is_looked_through) {
            EXPECT_EQ(*catalog_.mark_missing("/elsewhere"), 0);
        }
        EXPECT_TRUE(*catalog_.is_known("/d/KOUN_b"));
        EXPECT_TRUE(*catalog_.is_known("/d/KTLX_10000"));
        EXPECT_FALSE(*catalog_.is_known("/d/KOUN_c"));
    }
    ASSERT_TRUE(catalog_.register_file(file("/d/KOUN_b", {}, "KOUN")));
    EXPECT_TRUE(*catalog_.is_known("/d/KOUN_b"));
}

TEST_F(CatalogTest, AStationThatIsNewSinceTheDatabasesWereListedIsAsked) {
    EXPECT_FALSE(*catalog_.is_known("/d/a"));
    ASSERT_TRUE(catalog_.register_file(file("/d/KOUN_a", {}, "KTLX")));
    forget_homes(catalog_);
    EXPECT_TRUE(*catalog_.is_known("/d/KOUN_a"));
}

// Two files with the same volume have one row. The row stays as long as one of the files holds the
// volume.
TEST_F(CatalogTest, AVolumeStaysWhileAnotherFileHoldsIt) {
    ASSERT_TRUE(catalog_.register_file(file("/d/a", {volume("2022-03-17T00:00")})));
    ASSERT_TRUE(catalog_.register_file(file("/d/b", {volume("2022-03-17T00:00")})));
    EXPECT_EQ(catalog_.stations()->front().volume_count, 1);
    FileFacts rewritten = file("/d/a", {volume("2022-03-17T01:00")});
    rewritten.content_hash = 3;
    ASSERT_TRUE(catalog_.register_file(rewritten));
    EXPECT_EQ(catalog_.stations()->front().volume_count, 2);
    ASSERT_TRUE(catalog_.register_file(file("/d/b", {}, "KOUN")));
    const auto entries = catalog_.list("KTLX", {}).value();
    ASSERT_EQ(entries.size(), 1U);
    EXPECT_EQ(entries[0].path, "/d/a");
    EXPECT_EQ(*entries[0].volume.start_time, at("2022-03-17T01:00"));
    const auto stations = catalog_.stations().value();
    for (const StationSummary& station : stations)
        EXPECT_EQ(station.volume_count, station.station == "KTLX" ? 1 : 0) << station.station;
}

}  // namespace
}  // namespace stormcellar::catalog
