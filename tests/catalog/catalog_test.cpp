#include "catalog/catalog.h"

#include <cerrno>
#include <fstream>
#include <thread>

#include <SQLiteCpp/SQLiteCpp.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include "tests/testing/temporary_directory.h"

namespace stormcellar::catalog {
namespace {

UtcTime at(const char* text) {
    return *parse_utc(text, UtcTime{});
}

VolumeFacts volume(const char* start, std::optional<int> number = 7) {
    VolumeFacts facts;
    facts.start_time = at(start);
    facts.end_time = at(start) + std::chrono::minutes{5};
    facts.volume_number = number;
    facts.vcp = 212;
    facts.sweep_count = 14;
    facts.radial_count = 6480;
    facts.complete = true;
    return facts;
}

FileFacts file(const std::string& path, std::vector<VolumeFacts> volumes,
               const std::string& station = "KTLX") {
    FileFacts facts;
    facts.path = path;
    facts.station = station;
    facts.size_bytes = 1000;
    facts.modified_ns = 42;
    facts.content_hash = 0xFEDC'BA98'7654'3210;  // uses the sign bit of SQLite's integers
    facts.state = FileState::complete;
    facts.volumes = std::move(volumes);
    return facts;
}

class CatalogTest : public ::testing::Test {
  protected:
    testing::TemporaryDirectory directory_;
    Catalog catalog_ = *Catalog::open_for_writing(directory_ / "catalog");
};

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
    EXPECT_TRUE(catalog_.list("KTLX", {})->empty()) << "there is no volume in them";
    EXPECT_EQ(catalog_.list("KTLX", {std::nullopt, std::nullopt, true})->size(), 2U);
    ASSERT_TRUE(catalog_.register_files("KTLX", {first, second})) << "and again";
    ASSERT_TRUE(catalog_.register_files("KTLX", {}));
}

// Opens nothing for writing, as when descriptors run out or a disk fails.
int open_for_reading_alone(const char* path, int flags, int mode) {
    if ((flags & O_ACCMODE) == O_RDONLY) return ::open(path, flags, mode);
    errno = EIO;
    return -1;
}

// 2026-11-22: a database that was opened in such a moment could not be written until the next
// start.
TEST_F(CatalogTest, WhatCouldOnlyBeOpenedForReadingIsOpenedAgain) {
    ASSERT_TRUE(catalog_.register_file(file("/d/a", {volume("2022-03-17T00:00")})));
    Catalog second = *Catalog::open_for_writing(directory_ / "catalog");
    sqlite3_vfs* const vfs = sqlite3_vfs_find("unix");
    ASSERT_EQ(vfs->xSetSystemCall(vfs, "open",
                                  reinterpret_cast<sqlite3_syscall_ptr>(&open_for_reading_alone)),
              SQLITE_OK);
    const auto refused = second.register_file(file("/d/b", {volume("2022-03-17T00:10")}));
    ASSERT_EQ(vfs->xSetSystemCall(vfs, "open", nullptr), SQLITE_OK);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::permission) << refused.error().message;
    const auto taken = second.register_file(file("/d/b", {volume("2022-03-17T00:10")}));
    EXPECT_TRUE(taken) << taken.error().message;
    EXPECT_EQ(second.list("KTLX", {})->size(), 2U);
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

// Wherever a file stood before, in this program's time or another's, it has one row.
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
            if (reopened) catalog_ = *Catalog::open_for_writing(directory_ / "catalog");
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

// What is noted unread never undoes what was found by reading, wherever that stands.
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
    ASSERT_EQ(unknown.size(), 1U) << "the note of b went when it was read";
    EXPECT_EQ(unknown[0].path, "/d/a");
}

TEST_F(CatalogTest, AFileThatWasNowhereWhileItIsWrittenIsFoundAfterwards) {
    EXPECT_FALSE(*catalog_.is_known("/d/a"));
    ASSERT_TRUE(catalog_.register_files("KTLX", {file("/d/a", {})}));
    EXPECT_TRUE(*catalog_.is_settled("/d/a", 1000, 42));
    EXPECT_FALSE(*catalog_.is_known("/d/b"));
    ASSERT_TRUE(catalog_.register_file(file("/d/b", {})));
    EXPECT_TRUE(*catalog_.is_settled("/d/b", 1000, 42));
    EXPECT_EQ(*catalog_.mark_gone("/d/b"), 1);
}

TEST_F(CatalogTest, GoneFilesStayAndAreMarkedOnce) {
    ASSERT_TRUE(catalog_.register_file(file("/d/a", {volume("2022-03-17T00:00")})));
    EXPECT_EQ(*catalog_.mark_gone("/d/a"), 1);
    EXPECT_EQ(*catalog_.mark_gone("/d/a"), 0);
    EXPECT_EQ(catalog_.list("KTLX", {})->at(0).state, FileState::gone);
}

// Any byte but NUL and the slash may stand in a file name.
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

TEST_F(CatalogTest, StationThatIsNoIcaoNeverBecomesAFileName) {
    ASSERT_TRUE(
        catalog_.register_file(file("/d/a", {volume("2022-03-17T00:00")}, "../../../tmp/x")));
    EXPECT_TRUE(std::filesystem::exists(directory_ / "catalog" / "_unknown.sqlite"));
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(directory_.path()), {}), 1);
}

TEST_F(CatalogTest, ReaderSeesWhatTheWriterWroteAndWritesNothing) {
    ASSERT_TRUE(catalog_.register_file(file("/d/a", {volume("2022-03-17T00:00")})));
    auto reader = Catalog::open_for_reading(directory_ / "catalog");
    ASSERT_TRUE(reader);
    EXPECT_EQ(reader->list("KTLX", {})->size(), 1U);
    EXPECT_EQ(reader->list("KOKX", {}).error().code, ErrorCode::not_found);
    EXPECT_FALSE(std::filesystem::exists(directory_ / "catalog" / "KOKX.sqlite"));
}

TEST(CatalogOpen, MissingDirectoryIsNotFoundForReaders) {
    const auto catalog = Catalog::open_for_reading("/nonexistent/catalog");
    ASSERT_FALSE(catalog);
    EXPECT_EQ(catalog.error().code, ErrorCode::not_found);
}

TEST_F(CatalogTest, SomethingThatIsNoDatabaseIsNamedToAReader) {
    std::ofstream(directory_ / "catalog" / "KOKX.sqlite") << std::string(5000, 'x');
    auto reader = *Catalog::open_for_reading(directory_ / "catalog");
    const auto entries = reader.list("KOKX", {});
    ASSERT_FALSE(entries);
    EXPECT_EQ(entries.error().code, ErrorCode::corrupt);
    EXPECT_NE(entries.error().message.find("KOKX.sqlite"), std::string::npos);
}

TEST_F(CatalogTest, LaterSchemaAndForeignDatabaseAreRefused) {
    ASSERT_TRUE(catalog_.register_file(file("/d/a", {volume("2022-03-17T00:00")})));
    {
        SQLite::Database later(directory_ / "catalog" / "KTLX.sqlite", SQLite::OPEN_READWRITE);
        later.exec("PRAGMA user_version = 999");
        SQLite::Database foreign(directory_ / "catalog" / "KOKX.sqlite",
                                 SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
        foreign.exec("CREATE TABLE other (x)");
    }
    auto fresh = *Catalog::open_for_writing(directory_ / "catalog");
    EXPECT_EQ(fresh.list("KTLX", {}).error().code, ErrorCode::unsupported);
    EXPECT_EQ(fresh.list("KOKX", {}).error().code, ErrorCode::unsupported);
    EXPECT_TRUE(fresh.take_repairs().empty()) << "they are not ours to mend";
}

// Two catalogs on one directory, as two processes would have, many threads, the same files.
TEST_F(CatalogTest, ConcurrentWritersRegisterEachFileOnce) {
    auto other = *Catalog::open_for_writing(directory_ / "catalog");
    constexpr int files = 40;
    const auto work = [](Catalog& catalog) {
        for (int i = 0; i < files; ++i) {
            FileFacts facts = file(fmt::format("/d/{}", i), {});
            VolumeFacts one = volume("2022-03-17T00:00", i);
            facts.volumes = {one};
            const auto registered = catalog.register_file(facts);
            EXPECT_TRUE(registered) << registered.error().message;
        }
    };
    std::vector<std::thread> threads;
    for (int i = 0; i < 2; ++i) {
        threads.emplace_back([&] { work(catalog_); });
        threads.emplace_back([&] { work(other); });
    }
    for (auto& thread : threads)
        thread.join();
    EXPECT_EQ(catalog_.list("KTLX", {})->size(), static_cast<std::size_t>(files));
    EXPECT_EQ(catalog_.stations()->at(0).volume_count, files);
}

TEST(FileState, NamesRoundTrip) {
    for (const auto state : {FileState::seen, FileState::complete, FileState::partial,
                             FileState::rejected, FileState::gone}) {
        EXPECT_EQ(file_state_from_name(file_state_name(state)), state);
    }
    EXPECT_EQ(file_state_from_name("lost"), std::nullopt);
}

TEST_F(CatalogTest, WhatStandsAtAPathNowIsTheOnlyRowOfThatPath) {
    ASSERT_TRUE(catalog_.register_file(file("/d/current", {volume("2022-03-17T00:00")}, "KTLX")));
    ASSERT_TRUE(catalog_.register_file(file("/d/current", {volume("2022-03-17T01:00")}, "KDMX")));
    EXPECT_TRUE(catalog_.list("KTLX", {{}, {}, true})->empty());
    EXPECT_EQ(catalog_.list("KDMX", {})->size(), 1U);
    FileFacts rejected = file("/d/current", {}, "");
    rejected.state = FileState::rejected;
    ASSERT_TRUE(catalog_.register_file(rejected));
    EXPECT_TRUE(catalog_.list("KDMX", {{}, {}, true})->empty());
}

TEST_F(CatalogTest, AMisspeltStationIsNamedAndIsNotTheUnknownOnes) {
    FileFacts rejected = file("/d/noise", {}, "");
    rejected.state = FileState::rejected;
    ASSERT_TRUE(catalog_.register_file(rejected));
    for (const char* name : {"ktlx", "KTL", "../x", "KTLX "}) {
        EXPECT_EQ(catalog_.list(name, {{}, {}, true}).error().code, ErrorCode::bad_argument);
        EXPECT_EQ(catalog_.latest(name).error().code, ErrorCode::bad_argument);
        EXPECT_EQ(catalog_.oldest(name).error().code, ErrorCode::bad_argument);
    }
    EXPECT_EQ(catalog_.list("", {{}, {}, true})->size(), 1U);
}

TEST_F(CatalogTest, WhatCouldNotBeReadIsNeverSettled) {
    FileFacts unread = file("/d/KTLX_a", {});
    unread.state = FileState::rejected;
    unread.modified_ns = never_read_ns;
    ASSERT_TRUE(catalog_.register_file(unread));
    EXPECT_FALSE(*catalog_.is_settled("/d/KTLX_a", 1000, 42));
}

// A watchdog goes by the steps: one a station at least, and no more than 1,000 files between two.
TEST_F(CatalogTest, LookingForFilesThatWentSaysThatItMovesOn) {
    const std::filesystem::path drop = directory_ / "drop";
    ASSERT_TRUE(catalog_.register_file(file(drop / "a", {volume("2022-03-17T00:00")})));
    int steps = 0;
    EXPECT_EQ(*catalog_.mark_missing(drop, [&] { ++steps; }), 1);
    const int of_one_file = steps;
    EXPECT_GE(of_one_file, 1);
    for (int i = 0; i < 2500; ++i) {
        FileFacts unread = file(drop / fmt::format("KTLX_{}", i), {});
        unread.state = FileState::rejected;
        ASSERT_TRUE(catalog_.register_file(unread));
    }
    steps = 0;
    EXPECT_EQ(*catalog_.mark_missing(drop, [&] { ++steps; }), 2500);
    EXPECT_GE(steps, of_one_file + 2);
}

TEST_F(CatalogTest, FilesThatWentWhileNobodyWatchedAreMarked) {
    const std::filesystem::path drop = directory_ / "drop";
    std::filesystem::create_directory(drop);
    std::ofstream(drop / "stays") << "x";
    for (const char* name : {"stays", "went"})
        ASSERT_TRUE(catalog_.register_file(file(drop / name, {volume("2022-03-17T00:00")})));
    ASSERT_TRUE(catalog_.register_file(file("/elsewhere/went", {volume("2022-03-17T00:00")})));
    EXPECT_EQ(*catalog_.mark_missing(drop), 1);
    EXPECT_EQ(*catalog_.mark_missing(drop), 0);
    const auto entries = *catalog_.list("KTLX", {});
    EXPECT_EQ(entries.size(), 3U);
    for (const CatalogEntry& entry : entries) {
        EXPECT_EQ(entry.state, entry.path == drop / "went" ? FileState::gone : FileState::complete)
            << entry.path;
    }
}

// What a link leads to is none of the raw files, whatever its name.
TEST_F(CatalogTest, FilesBehindADirectoryThatBecameALinkAreGone) {
    const testing::TemporaryDirectory place;
    const std::filesystem::path drop = place / "drop";
    std::filesystem::create_directories(drop / "day");
    std::ofstream(drop / "day/a") << "x";
    ASSERT_TRUE(catalog_.register_file(file(drop / "day/a", {volume("2022-03-17T00:00")})));
    EXPECT_EQ(*catalog_.mark_missing(drop), 0);
    std::filesystem::rename(drop / "day", place / "elsewhere");
    std::filesystem::create_directory_symlink(place / "elsewhere", drop / "day");
    EXPECT_EQ(*catalog_.mark_missing(drop), 1);
}

}  // namespace
}  // namespace stormcellar::catalog
