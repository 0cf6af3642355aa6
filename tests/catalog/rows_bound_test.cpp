// Tests the size limits of databases. Rows of deleted files are removed to make room. If there are
// no such rows, new rows are left out.
#include <gtest/gtest.h>

#include "tests/catalog/catalog_fixture.h"

namespace stormcellar::catalog {
namespace {

class RowsBound : public ::testing::Test {
  protected:
    CatalogWriter open() { return *CatalogWriter::open(directory_ / "catalog", options_); }
    static std::string path(int k) { return fmt::format("/d/{:06}", k); }
    // Describes a file of an attack. Its state is `seen`, so that its row is not synced, which
    // saves time.
    static FileFacts unknown(int k) {
        FileFacts facts = file(path(k), {}, "");
        facts.state = FileState::seen;
        return facts;
    }
    [[nodiscard]] std::uint64_t bytes_of(const std::string& name) const {
        return fs::file_size(directory_ / "catalog" / (name + ".sqlite"));
    }
    testing::TemporaryDirectory directory_;
    CatalogOptions options_;
};

// 2026-11-24: each file with a new name took some 300 bytes of disk forever.
TEST_F(RowsBound, AtItsBoundTheDatabaseOfUnknownFilesLeavesNewOnesOut) {
    options_.most_unknown_bytes = 200'000;
    auto catalog = open();
    int added = 0;
    while (added < 4000 && *catalog.register_file(unknown(added)) == Registered::added)
        ++added;
    EXPECT_GT(added, 500);
    EXPECT_LT(added, 4000);
    for (int k = 5000; k < 5500; ++k) {
        ASSERT_EQ(*catalog.register_file(unknown(k)), Registered::left_out);
        ASSERT_FALSE(*catalog.is_known(path(k)));
        ASSERT_TRUE(catalog.note_file(unknown(k)));
        ASSERT_FALSE(*catalog.is_known(path(k)));
    }
    ASSERT_TRUE(catalog.register_files("", {unknown(6000), unknown(6001)}));
    EXPECT_FALSE(*catalog.is_known(path(6000)));
    EXPECT_EQ(catalog.list("", {{}, {}, true})->size(), static_cast<std::size_t>(added));
    FileFacts changed = unknown(7);
    changed.size_bytes = 7;
    EXPECT_EQ(*catalog.register_file(changed), Registered::updated)
        << "existing rows can be updated beyond the limit";
    EXPECT_EQ(*catalog.register_file(file("/d/KTLX", {})), Registered::added)
        << "other databases are not affected";
    EXPECT_TRUE(catalog.troubles().empty());
    catalog = open();
    EXPECT_LT(bytes_of("_unknown"), 220'000U);
}

TEST_F(RowsBound, RowsOfFilesThatAreGoneMakeRoomTheOldestFirst) {
    options_.most_unknown_bytes = 600'000;
    auto catalog = open();
    for (int k = 0; k < 2000; ++k)
        ASSERT_EQ(*catalog.register_file(unknown(k)), Registered::added);
    ASSERT_EQ(*catalog.mark_missing("/d"), 2000);
    for (int k = 2000; k < 12'000; ++k) {
        ASSERT_EQ(*catalog.register_file(unknown(k)), Registered::added) << k;
        if (k % 1000 == 999) {
            ASSERT_EQ(*catalog.mark_missing("/d"), 1000);
        }
    }
    EXPECT_FALSE(*catalog.is_known(path(0)));
    EXPECT_TRUE(*catalog.is_known(path(11'999)));
    EXPECT_TRUE(catalog.examine_all());
    EXPECT_TRUE(catalog.take_repairs().empty());
    catalog = open();
    EXPECT_LT(bytes_of("_unknown"), 650'000U);
}

TEST_F(RowsBound, AStationsOwnDatabaseHasItsBoundToo) {
    options_.most_station_bytes = 200'000;
    auto catalog = open();
    Registered last = Registered::added;
    for (int k = 0; k < 3000 && last == Registered::added; ++k) {
        FileFacts facts = unknown(k);
        facts.station = "KTLX";
        last = *catalog.register_file(facts);
    }
    EXPECT_EQ(last, Registered::left_out);
    EXPECT_EQ(*catalog.register_file(file("/d/KOUN", {}, "KOUN")), Registered::added);
}

TEST_F(RowsBound, RollingDeletesTheOldestRowsOfTheLargestDatabase) {
    {
        auto catalog = open();
        std::vector<FileFacts> many, few;
        for (int k = 0; k < 6000; ++k)
            many.push_back(file(path(k), {volume("2022-03-17T00:00", k % 1000)}));
        for (int k = 10'000; k < 10'100; ++k)
            few.push_back(file(path(k), {}, "KOUN"));
        ASSERT_TRUE(catalog.register_files("KTLX", many));
        ASSERT_TRUE(catalog.register_files("KOUN", few));
        ASSERT_EQ(*catalog.mark_missing("/d"), 6100);
        const auto all = catalog.roll();
        ASSERT_TRUE(all);
        EXPECT_EQ(all->rows, 0) << "without a limit, no rows are deleted";
        EXPECT_GT(all->used_bytes, 500'000U);
        options_.most_bytes = all->used_bytes / 2;
    }
    auto catalog = open();
    int steps = 0;
    const auto rolled = catalog.roll([&] { ++steps; });
    ASSERT_TRUE(rolled);
    EXPECT_GE(rolled->rows, 2000);
    EXPECT_LE(rolled->rows, 5000);
    EXPECT_LE(rolled->used_bytes, options_.most_bytes);
    EXPECT_GE(steps, 4);
    EXPECT_FALSE(*catalog.is_known(path(0)));
    EXPECT_TRUE(*catalog.is_known(path(5999)));
    EXPECT_EQ(catalog.list("KOUN", {{}, {}, true})->size(), 100U)
        << "rows of smaller databases stay";
    EXPECT_EQ(catalog.roll()->rows, 0);
    EXPECT_TRUE(catalog.examine_all());
    EXPECT_TRUE(catalog.take_repairs().empty());

    // Rows of existing files stay, even beyond the limit.
    options_.most_bytes = 1;
    catalog = open();
    ASSERT_TRUE(catalog.register_file(file("/d/there", {})));
    EXPECT_TRUE(catalog.roll());
    EXPECT_TRUE(*catalog.is_known("/d/there"));
    EXPECT_FALSE(*catalog.is_known(path(5999)));
}

// 2026-11-25: for junk files with one station's name, rows of another station's deleted files were
// removed.
TEST_F(RowsBound, RowsThatStandTakeNoOtherStationsHistory) {
    {
        auto catalog = open();
        std::vector<FileFacts> standing, history;
        for (int k = 0; k < 4000; ++k)
            standing.push_back(file(path(k), {}));
        for (int k = 10'000; k < 10'100; ++k)
            history.push_back(file("/e/" + std::to_string(k), {}, "KOUN"));
        ASSERT_TRUE(catalog.register_files("KTLX", standing));
        ASSERT_TRUE(catalog.register_files("KOUN", history));
        ASSERT_EQ(*catalog.mark_missing("/e"), 100);
        options_.most_bytes = catalog.roll()->used_bytes * 3 / 4;
    }
    auto catalog = open();
    EXPECT_EQ(catalog.roll()->rows, 0);
    EXPECT_EQ(catalog.list("KOUN", {{}, {}, true})->size(), 100U);
}

TEST_F(RowsBound, OfAFileWithVeryManyVolumesTheFirstGetRows) {
    auto catalog = open();
    FileFacts facts = unknown(1);
    facts.station = "KTLX";
    for (int k = 0; k < 1500; ++k) {
        facts.volumes.push_back(volume("2022-03-17T00:00", k % 1000));
        *facts.volumes.back().start_time += std::chrono::minutes{k};
    }
    ASSERT_TRUE(catalog.register_file(facts));
    const auto entries = *catalog.list("KTLX", {});
    ASSERT_EQ(entries.size(), most_volumes_a_file);
    EXPECT_EQ(entries.back().volume.start_time, facts.volumes[999].start_time);
}

// The database was written before there were limits.
TEST_F(RowsBound, RollingBringsADatabaseBelowItsOwnBound) {
    {
        auto catalog = open();
        std::vector<FileFacts> many;
        for (int k = 0; k < 4000; ++k)
            many.push_back(file(path(k), {}, ""));
        ASSERT_TRUE(catalog.register_files("", many));
        ASSERT_EQ(*catalog.mark_missing("/d"), 4000);
    }
    options_.most_unknown_bytes = 300'000;
    auto catalog = open();
    const auto rolled = catalog.roll();
    ASSERT_TRUE(rolled);
    EXPECT_GE(rolled->rows, 1000);
    EXPECT_LT(rolled->used_bytes, 300'000U);
}

}  // namespace
}  // namespace stormcellar::catalog
