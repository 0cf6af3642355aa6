#include "stormcellar/catalog/catalog.h"

#include <gtest/gtest.h>

#include "tests/catalog/catalog_fixture.h"

namespace stormcellar::catalog {
namespace {

TEST_F(CatalogTest, RegisteringTheSameFileTwiceChangesNothing) {
    const FileFacts facts = file("/d/a", {volume("2022-03-17T00:00")});
    EXPECT_EQ(*catalog_.register_file(facts), Registered::added);
    EXPECT_EQ(*catalog_.register_file(facts), Registered::unchanged);
    EXPECT_EQ(catalog_.list("KTLX", {})->size(), 1U);
}

TEST_F(CatalogTest, SeveralFilesAreRegisteredTogether) {
    FileFacts first = file("/d/a", {});
    FileFacts second = file("/d/b", {});
    ASSERT_TRUE(catalog_.register_files("KTLX", {first, second}));
    for (const char* path : {"/d/a", "/d/b"})
        EXPECT_TRUE(*catalog_.is_settled(path, 1000, 42)) << path;
    EXPECT_TRUE(catalog_.list("KTLX", {})->empty()) << "the files have no volume";
    EXPECT_EQ(catalog_.list("KTLX", {std::nullopt, std::nullopt, true})->size(), 2U);
    ASSERT_TRUE(catalog_.register_files("KTLX", {first, second}))
        << "registering again should succeed";
    ASSERT_TRUE(catalog_.register_files("KTLX", {}));
}

TEST_F(CatalogTest, KeepsEveryFact) {
    ASSERT_TRUE(catalog_.register_file(file("/d/a", {volume("2022-03-17T00:00:00.250Z")})));
    const CatalogEntry entry = catalog_.list("KTLX", {})->at(0);
    EXPECT_EQ(entry.station, "KTLX");
    EXPECT_EQ(entry.path, "/d/a");
    EXPECT_EQ(entry.size_bytes, 1000U);
    EXPECT_EQ(entry.state, FileState::complete);
    EXPECT_EQ(entry.generation, 0);
    EXPECT_EQ(entry.volume.start_time, at("2022-03-17T00:00:00.250Z"));
    EXPECT_EQ(entry.volume.end_time, at("2022-03-17T00:05:00.250Z"));
    EXPECT_EQ(entry.volume.volume_number, 7);
    EXPECT_EQ(entry.volume.vcp, 212);
    EXPECT_EQ(entry.volume.sweep_count, 14);
    EXPECT_EQ(entry.volume.radial_count, 6480);
    EXPECT_TRUE(entry.volume.complete);
}

TEST_F(CatalogTest, GrowingFileStaysOneVolumeOfOneGeneration) {
    FileFacts facts = file("/d/a", {volume("2022-03-17T00:00")});
    facts.state = FileState::seen;
    ASSERT_TRUE(catalog_.register_file(facts));
    facts.size_bytes = 2000;
    facts.content_hash = 2;
    facts.state = FileState::complete;
    EXPECT_EQ(*catalog_.register_file(facts), Registered::updated);
    const auto entries = *catalog_.list("KTLX", {});
    ASSERT_EQ(entries.size(), 1U);
    EXPECT_EQ(entries[0].size_bytes, 2000U);
    EXPECT_EQ(entries[0].generation, 0);
}

TEST_F(CatalogTest, ResendThatDiffersIsTheNextGenerationAndACopyIsNot) {
    FileFacts first = file("/d/a", {volume("2022-03-17T00:00")});
    FileFacts copy = file("/d/copy", {volume("2022-03-17T00:00")});
    FileFacts other = file("/d/b", {volume("2022-03-17T00:00")});
    other.content_hash = 99;
    ASSERT_TRUE(catalog_.register_file(first));
    ASSERT_TRUE(catalog_.register_file(copy));
    ASSERT_TRUE(catalog_.register_file(other));
    const auto entries = *catalog_.list("KTLX", {});
    ASSERT_EQ(entries.size(), 3U);
    EXPECT_EQ(entries[0].generation, 0);
    EXPECT_EQ(entries[1].generation, 0);
    EXPECT_EQ(entries[2].generation, 1);
    EXPECT_EQ(catalog_.stations()->at(0).volume_count, 2);
    EXPECT_EQ((*catalog_.latest("KTLX"))->path, "/d/b");
}

TEST_F(CatalogTest, FileWithSeveralVolumesListsEach) {
    ASSERT_TRUE(catalog_.register_file(
        file("/d/a", {volume("2022-03-17T00:10"), volume("2022-03-17T00:00", std::nullopt)})));
    const auto entries = *catalog_.list("KTLX", {});
    ASSERT_EQ(entries.size(), 2U);
    EXPECT_EQ(entries[0].volume.volume_number, std::nullopt);
    EXPECT_LT(entries[0].volume.start_time, entries[1].volume.start_time);
}

TEST_F(CatalogTest, BoundsAreInclusiveAndOrderIsByTime) {
    ASSERT_TRUE(catalog_.register_file(file("/d/c", {volume("2022-03-17T02:00")})));
    ASSERT_TRUE(catalog_.register_file(file("/d/a", {volume("2022-03-17T00:00")})));
    ASSERT_TRUE(catalog_.register_file(file("/d/b", {volume("2022-03-17T01:00")})));
    const Query query{at("2022-03-17T00:00"), at("2022-03-17T01:00"), false};
    const auto entries = *catalog_.list("KTLX", query);
    ASSERT_EQ(entries.size(), 2U);
    EXPECT_EQ(entries[0].path, "/d/a");
    EXPECT_EQ(entries[1].path, "/d/b");
    EXPECT_EQ((*catalog_.oldest("KTLX"))->path, "/d/a");
    EXPECT_EQ((*catalog_.latest("KTLX"))->path, "/d/c");
}

TEST_F(CatalogTest, RejectedFilesAreListedOnRequestWithTheirReason) {
    FileFacts bad = file("/d/bad", {}, "");
    bad.state = FileState::rejected;
    bad.reason = "not a Level II file";
    ASSERT_TRUE(catalog_.register_file(bad));
    EXPECT_TRUE(catalog_.list("", {})->empty());
    const auto entries = *catalog_.list("", {std::nullopt, std::nullopt, true});
    ASSERT_EQ(entries.size(), 1U);
    EXPECT_EQ(entries[0].reason, "not a Level II file");
    EXPECT_EQ(entries[0].state, FileState::rejected);
    EXPECT_EQ(catalog_.stations()->at(0).rejected_count, 1);
}

TEST_F(CatalogTest, FileMovesFromUnknownToItsStationOnceThatIsKnown) {
    FileFacts facts = file("/d/a", {}, "");
    facts.state = FileState::seen;
    ASSERT_TRUE(catalog_.register_file(facts));
    ASSERT_TRUE(catalog_.register_file(file("/d/a", {volume("2022-03-17T00:00")})));
    EXPECT_TRUE(catalog_.list("", {std::nullopt, std::nullopt, true})->empty());
    EXPECT_EQ(catalog_.list("KTLX", {})->size(), 1U);
}

TEST_F(CatalogTest, SettledMeansSameSizeAndTimeAndDecodedToItsEnd) {
    FileFacts facts = file("/some/where/oddly-named", {volume("2022-03-17T00:00")});
    EXPECT_FALSE(*catalog_.is_settled(facts.path, 1000, 42));
    facts.state = FileState::seen;
    ASSERT_TRUE(catalog_.register_file(facts));
    EXPECT_FALSE(*catalog_.is_settled(facts.path, 1000, 42));
    facts.state = FileState::complete;
    ASSERT_TRUE(catalog_.register_file(facts));
    EXPECT_TRUE(*catalog_.is_settled(facts.path, 1000, 42));
    EXPECT_FALSE(*catalog_.is_settled(facts.path, 1001, 42));
    EXPECT_FALSE(*catalog_.is_settled(facts.path, 1000, 43));
}

// A file has one row, even if this or an earlier catalog object registered it for another station.
TEST_F(CatalogTest, AFileHasOneRowWhateverItsStationWas) {
    const auto rows = [&] {
        std::string found;
        const auto stations = catalog_.stations().value();
        for (const StationSummary& station : stations) {
            const auto entries =
                catalog_.list(station.station, {std::nullopt, std::nullopt, true}).value();
            for (const CatalogEntry& entry : entries)
                found += entry.path.native() + "@" + entry.station + " ";
        }
        return found;
    };
    for (const bool reopened : {false, true}) {
        SCOPED_TRACE(reopened);
        const auto reopen = [&] {
            if (reopened) catalog_ = *CatalogWriter::open(directory_ / "catalog");
        };
        for (const bool asked : {false, true}) {
            for (const char* station : {"", "KTLX", "KOUN", "KTLX"}) {
                reopen();
                if (asked) (void)*catalog_.is_settled("/d/a", 1, 1);
                ASSERT_TRUE(catalog_.register_file(file("/d/a", {}, station)));
                EXPECT_EQ(rows(), std::string{"/d/a@"} + station + " ");
                EXPECT_TRUE(*catalog_.is_known("/d/a"));
            }
        }
        for (const char* station : {"", "KOUN", "KTLX"}) {
            reopen();
            ASSERT_TRUE(catalog_.register_files(station, {file("/d/a", {}, station)}));
            EXPECT_EQ(rows(), std::string{"/d/a@"} + station + " ");
        }
        reopen();
        EXPECT_FALSE(*catalog_.is_known("/d/never"));
        EXPECT_EQ(*catalog_.mark_gone("/d/never"), 0);
        EXPECT_EQ(*catalog_.mark_gone("/d/a"), 1);
    }
}

// If a file that was read has a row in any database, note_file() leaves this row as it is and adds
// no other.
TEST_F(CatalogTest, ANoteGivesWayToWhatIsKnown) {
    FileFacts note = file("/d/a", {}, "");
    note.state = FileState::seen;
    for (const char* station : {"KTLX", ""}) {
        ASSERT_TRUE(catalog_.register_file(file("/d/a", {volume("2022-03-17T00:00")}, station)));
        ASSERT_TRUE(catalog_.note_file(note));
        EXPECT_EQ(catalog_.list(station, {}).value().size(), 1U) << station;
        EXPECT_TRUE(*catalog_.is_settled("/d/a", 1000, 42));
    }
    EXPECT_TRUE(catalog_.list("KTLX", {std::nullopt, std::nullopt, true}).value().empty());
    note.path = "/d/b";
    ASSERT_TRUE(catalog_.note_file(note));
    EXPECT_TRUE(*catalog_.is_known("/d/b"));
    ASSERT_TRUE(catalog_.register_file(file("/d/b", {})));
    const auto unknown = catalog_.list("", {std::nullopt, std::nullopt, true}).value();
    ASSERT_EQ(unknown.size(), 1U)
        << "registering b for KTLX deletes its row in the database of unknown stations";
    EXPECT_EQ(unknown[0].path, "/d/a");
}

TEST_F(CatalogTest, AFileThatWasNotKnownIsFoundOnceItIsRegistered) {
    EXPECT_FALSE(*catalog_.is_known("/d/a"));
    ASSERT_TRUE(catalog_.register_files("KTLX", {file("/d/a", {})}));
    EXPECT_TRUE(*catalog_.is_settled("/d/a", 1000, 42));
    EXPECT_FALSE(*catalog_.is_known("/d/b"));
    ASSERT_TRUE(catalog_.register_file(file("/d/b", {})));
    EXPECT_TRUE(*catalog_.is_settled("/d/b", 1000, 42));
    EXPECT_EQ(*catalog_.mark_gone("/d/b"), 1);
}

// The name of a file may contain any byte but NUL and the slash.
TEST_F(CatalogTest, OddFileNamesComeBackAsTheyWere) {
    const std::vector<std::string> names = {"/d/new\nline", "/d/quo'te\"", "/d/\xFF\xFE",
                                            "/d/caf\xC3\xA9", "/d/" + std::string(255, 'x')};
    for (const std::string& name : names) {
        ASSERT_TRUE(catalog_.register_file(file(name, {volume("2022-03-17T00:00")}))) << name;
        EXPECT_TRUE(*catalog_.is_settled(name, 1000, 42)) << name;
    }
    const auto entries = catalog_.list("KTLX", {});
    ASSERT_TRUE(entries);
    std::vector<std::string> found;
    for (const auto& entry : *entries)
        found.push_back(entry.path);
    EXPECT_EQ(found.size(), names.size());
    for (const std::string& name : names)
        EXPECT_NE(std::find(found.begin(), found.end(), name), found.end()) << name;
}

TEST(FileState, NamesRoundTrip) {
    for (const auto state : {FileState::seen, FileState::complete, FileState::partial,
                             FileState::rejected, FileState::gone}) {
        EXPECT_EQ(file_state_from_name(file_state_name(state)), state);
    }
    EXPECT_EQ(file_state_from_name("lost"), std::nullopt);
}

TEST_F(CatalogTest, WhatCouldNotBeReadIsNeverSettled) {
    FileFacts unread = file("/d/KTLX_a", {});
    unread.state = FileState::rejected;
    unread.modified_ns = never_read_ns;
    ASSERT_TRUE(catalog_.register_file(unread));
    EXPECT_FALSE(*catalog_.is_settled("/d/KTLX_a", 1000, 42));
}
}  // namespace
}  // namespace stormcellar::catalog
