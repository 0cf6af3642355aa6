// Tests how databases are opened, also by several processes and by readers. Tests raw files that
// were deleted.
#include <algorithm>
#include <cerrno>
#include <fstream>
#include <thread>

#include <SQLiteCpp/SQLiteCpp.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include "tests/catalog/catalog_fixture.h"

namespace stormcellar::catalog {
namespace {

// Opens files like open(), but refuses to open them for writing, as if descriptors ran out or a
// disk failed.
int open_for_reading_alone(const char* path, int flags, int mode) {
    if ((flags & O_ACCMODE) == O_RDONLY) return ::open(path, flags, mode);
    errno = EIO;
    return -1;
}

// 2026-11-22: a database that was opened while files could not be opened for writing could not be
// written until the next start.
TEST_F(CatalogTest, WhatCouldOnlyBeOpenedForReadingIsOpenedAgain) {
    ASSERT_TRUE(catalog_.register_file(file("/d/a", {volume("2022-03-17T00:00")})));
    CatalogWriter second = *CatalogWriter::open(directory_ / "catalog");
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

// 2026-11-27: a server answered with 500 if it listed a station while the station's first file was
// registered.
TEST_F(CatalogTest, ToReadersADatabaseThatIsJustBeingMadeIsEmptyAndFullSoonAfter) {
    ASSERT_TRUE(catalog_.register_file(file("/d/a", {volume("2022-03-17T00:00")})));
    const CatalogReader reader = *CatalogReader::open(directory_ / "catalog");
    const fs::path path = directory_ / "catalog" / "KLBB.sqlite";
    ASSERT_TRUE(fs::exists(directory_ / "catalog" / "KTLX.sqlite"));
    {
        SQLite::Database made(path, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
        made.exec("PRAGMA journal_mode = WAL");
        const auto listed = reader.list("KLBB", {});
        ASSERT_TRUE(listed) << listed.error().message;
        EXPECT_TRUE(listed->empty());
        const auto latest = reader.latest("KLBB");
        ASSERT_TRUE(latest) << latest.error().message;
        EXPECT_FALSE(latest->has_value());
    }
    ASSERT_TRUE(catalog_.register_file(file("/d/b", {volume("2022-03-17T00:10")}, "KLBB")));
    const auto listed = reader.list("KLBB", {});
    ASSERT_TRUE(listed) << listed.error().message;
    EXPECT_EQ(listed->size(), 1U);
}

TEST_F(CatalogTest, GoneFilesStayAndAreMarkedOnce) {
    ASSERT_TRUE(catalog_.register_file(file("/d/a", {volume("2022-03-17T00:00")})));
    EXPECT_EQ(*catalog_.mark_gone("/d/a"), 1);
    EXPECT_EQ(*catalog_.mark_gone("/d/a"), 0);
    EXPECT_EQ(catalog_.list("KTLX", {})->at(0).state, FileState::gone);
}

TEST_F(CatalogTest, RowsOfFilesThatWentLongAgoAreDeletedWithWhatNoOtherFileHolds) {
    const VolumeFacts first = volume("2022-03-17T00:00"), second = volume("2022-03-17T00:10");
    ASSERT_TRUE(catalog_.register_file(file("/d/gone", {first})));
    ASSERT_TRUE(catalog_.register_file(file("/d/gone-with-a-copy", {second})));
    ASSERT_TRUE(catalog_.register_file(file("/d/copy", {second})));
    ASSERT_TRUE(catalog_.register_file(file("/d/unknown", {}, "")));
    for (const char* path : {"/d/gone", "/d/gone-with-a-copy", "/d/unknown"})
        ASSERT_EQ(*catalog_.mark_gone(path), 1);
    const UtcTime now = now_utc();
    EXPECT_EQ(*catalog_.forget_gone(now - std::chrono::hours{1}), 0)
        << "no row is older than an hour";
    EXPECT_EQ(catalog_.list("KTLX", {})->size(), 3U);
    int steps = 0;
    EXPECT_EQ(*catalog_.forget_gone(now + std::chrono::hours{1}, [&] { ++steps; }), 3);
    EXPECT_GE(steps, 2) << "step is called for each database";
    const auto left = *catalog_.list("KTLX", {});
    ASSERT_EQ(left.size(), 1U);
    EXPECT_EQ(left[0].path, "/d/copy");
    EXPECT_EQ(left[0].volume.start_time, second.start_time);
    const auto stations = *catalog_.stations();
    const auto ktlx = std::find_if(stations.begin(), stations.end(),
                                   [](const StationSummary& one) { return one.station == "KTLX"; });
    ASSERT_NE(ktlx, stations.end());
    EXPECT_EQ(ktlx->volume_count, 1) << "volumes without a file are deleted";
    EXPECT_FALSE(*catalog_.is_known("/d/gone"));
    EXPECT_FALSE(*catalog_.is_known("/d/unknown"));
    EXPECT_TRUE(catalog_.examine_all());
    EXPECT_TRUE(catalog_.take_repairs().empty()) << "the databases should be sound";
    // A file that comes again gets a new row.
    EXPECT_EQ(*catalog_.register_file(file("/d/gone", {first})), Registered::added);
}

TEST_F(CatalogTest, RowsOfThousandsOfFilesThatWentAreDeletedInBatches) {
    std::vector<FileFacts> files;
    for (int i = 0; i < 2500; ++i)
        files.push_back(file("/d/" + std::to_string(i), {volume("2022-03-17T00:00", i % 1000)}));
    ASSERT_TRUE(catalog_.register_files("KTLX", files));
    ASSERT_EQ(*catalog_.mark_missing("/d"), 2500);
    int steps = 0;
    EXPECT_EQ(*catalog_.forget_gone(now_utc() + std::chrono::hours{1}, [&] { ++steps; }), 2500);
    EXPECT_GE(steps, 4);
    EXPECT_TRUE(catalog_.list("KTLX", {})->empty());
}

TEST_F(CatalogTest, StationThatIsNoIcaoNeverBecomesAFileName) {
    ASSERT_TRUE(
        catalog_.register_file(file("/d/a", {volume("2022-03-17T00:00")}, "../../../tmp/x")));
    EXPECT_TRUE(fs::exists(directory_ / "catalog" / "_unknown.sqlite"));
    EXPECT_EQ(std::distance(fs::directory_iterator(directory_.path()), {}), 1);
}

TEST_F(CatalogTest, ReaderSeesWhatTheWriterWroteAndWritesNothing) {
    ASSERT_TRUE(catalog_.register_file(file("/d/a", {volume("2022-03-17T00:00")})));
    auto reader = CatalogReader::open(directory_ / "catalog");
    ASSERT_TRUE(reader);
    EXPECT_EQ(reader->list("KTLX", {})->size(), 1U);
    EXPECT_EQ(reader->list("KOKX", {}).error().code, ErrorCode::not_found);
    EXPECT_FALSE(fs::exists(directory_ / "catalog" / "KOKX.sqlite"));
}

TEST(CatalogOpen, MissingDirectoryIsNotFoundForReaders) {
    const auto catalog = CatalogReader::open("/nonexistent/catalog");
    ASSERT_FALSE(catalog);
    EXPECT_EQ(catalog.error().code, ErrorCode::not_found);
}

TEST_F(CatalogTest, SomethingThatIsNoDatabaseIsNamedToAReader) {
    std::ofstream(directory_ / "catalog" / "KOKX.sqlite") << std::string(5000, 'x');
    auto reader = *CatalogReader::open(directory_ / "catalog");
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
    auto fresh = *CatalogWriter::open(directory_ / "catalog");
    EXPECT_EQ(fresh.list("KTLX", {}).error().code, ErrorCode::unsupported);
    EXPECT_EQ(fresh.list("KOKX", {}).error().code, ErrorCode::unsupported);
    EXPECT_TRUE(fresh.take_repairs().empty()) << "unsupported databases are not repaired";
}

// Many threads register the same files through two catalogs in one directory, as two processes
// would.
TEST_F(CatalogTest, ConcurrentWritersRegisterEachFileOnce) {
    auto other = *CatalogWriter::open(directory_ / "catalog");
    constexpr int files = 40;
    const auto work = [](CatalogWriter& catalog) {
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

// A watchdog needs a call of `step` for each station, and after at most 1,000 files.
TEST_F(CatalogTest, LookingForFilesThatWentSaysThatItMovesOn) {
    const fs::path drop = directory_ / "drop";
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
    const fs::path drop = directory_ / "drop";
    fs::create_directory(drop);
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

// A file behind a link is not a raw file, even if it has a raw file's name.
TEST_F(CatalogTest, FilesBehindADirectoryThatBecameALinkAreGone) {
    const testing::TemporaryDirectory place;
    const fs::path drop = place / "drop";
    fs::create_directories(drop / "day");
    std::ofstream(drop / "day/a") << "x";
    ASSERT_TRUE(catalog_.register_file(file(drop / "day/a", {volume("2022-03-17T00:00")})));
    EXPECT_EQ(*catalog_.mark_missing(drop), 0);
    fs::rename(drop / "day", place / "elsewhere");
    fs::create_directory_symlink(place / "elsewhere", drop / "day");
    EXPECT_EQ(*catalog_.mark_missing(drop), 1);
}
}  // namespace
}  // namespace stormcellar::catalog
