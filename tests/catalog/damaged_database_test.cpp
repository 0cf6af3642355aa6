// Tests databases that another program or the disk has damaged. They are set aside, and their
// readable rows are kept.
#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <map>

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>

#include "stormcellar/base/file_system.h"
#include "stormcellar/catalog/catalog.h"
#include "tests/catalog/power_cut_vfs.h"
#include "tests/testing/file_bytes.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::catalog {
namespace {

constexpr std::size_t page = 4096;

FileFacts facts_of(int number, const fs::path& directory = "/gone") {
    FileFacts facts;
    facts.path = directory / fmt::format("KTLX-{:06}", number);
    facts.station = "KTLX";
    facts.size_bytes = 1000U + static_cast<unsigned>(number);
    facts.modified_ns = number;
    facts.content_hash = static_cast<std::uint64_t>(number);
    facts.state = FileState::seen;  // such rows are not synced, which saves time
    facts.reason = fmt::format("reason {}", number);
    VolumeFacts volume;
    volume.start_time = UtcTime{std::chrono::minutes{number}};
    volume.volume_number = number % 1000;
    volume.vcp = 212;
    facts.volumes = {volume};
    return facts;
}

class DamagedDatabase : public ::testing::Test {
  protected:
    void fill(int from, int to, const fs::path& directory = "/gone") {
        auto catalog = *CatalogWriter::open(catalog_);
        for (int number = from; number < to; ++number)
            ASSERT_TRUE(catalog.register_file(facts_of(number, directory)));
    }
    std::vector<std::byte> bytes() { return *read_file(database_); }
    void overwrite(const std::vector<std::byte>& changed) {
        testing::write_bytes(database_, changed);
    }
    // Damages the pages of the table `file` that contain the text, but not the pages of indices.
    void damage_page_with(const std::string& text) {
        auto changed = bytes();
        for (std::size_t at = page; at + page <= changed.size(); at += page) {
            const std::string_view here(reinterpret_cast<const char*>(changed.data()) + at, page);
            const bool is_table_leaf = here.front() == '\x0D';
            if (is_table_leaf && here.find(text) != std::string_view::npos) {
                std::fill_n(changed.begin() + static_cast<std::ptrdiff_t>(at), page,
                            std::byte{0xA5});
            }
        }
        overwrite(changed);
    }
    // Returns the databases that were set aside in the catalog's directory.
    std::vector<fs::path> set_aside() {
        std::vector<fs::path> found;
        for (const auto& entry : fs::directory_iterator(catalog_)) {
            const std::string name = entry.path().filename();
            if (name.find(".damaged-") != std::string::npos && !name.ends_with("-wal") &&
                !name.ends_with("-shm")) {
                found.push_back(entry.path());
            }
        }
        return found;
    }
    // Returns the number of rows, and expects each to be as it was registered.
    std::size_t expect_true_rows(const CatalogReader& catalog) {
        const auto entries = *catalog.list("KTLX", {});
        for (const CatalogEntry& entry : entries) {
            const int number = std::stoi(entry.path.filename().native().substr(5));
            const FileFacts facts = facts_of(number, entry.path.parent_path());
            EXPECT_EQ(entry.size_bytes, facts.size_bytes);
            EXPECT_EQ(entry.reason, facts.reason);
            EXPECT_EQ(entry.volume.start_time, facts.volumes[0].start_time);
            EXPECT_EQ(entry.volume.volume_number, facts.volumes[0].volume_number);
            EXPECT_EQ(entry.state, FileState::gone);
        }
        return entries.size();
    }

    testing::PowerCutVfs without_syncs_;  // avoids real syncs, which take most of the time
    testing::TemporaryDirectory directory_;
    fs::path catalog_ = directory_ / "catalog";
    fs::path database_ = catalog_ / "KTLX.sqlite";
};

TEST_F(DamagedDatabase, NoiseInItsPlaceIsSetAsideAndTheStationGoesOn) {
    const std::string noise(5000, 'x');
    fs::create_directory(catalog_);
    std::ofstream(database_) << noise;
    auto catalog = *CatalogWriter::open(catalog_);
    EXPECT_FALSE(*catalog.is_settled("/d/KTLX_a", 1, 1));
    ASSERT_TRUE(catalog.register_file(facts_of(1)));
    EXPECT_EQ(catalog.list("KTLX", {})->size(), 1U);
    const auto repairs = catalog.take_repairs();
    ASSERT_EQ(repairs.size(), 1U);
    EXPECT_EQ(repairs[0].station, "KTLX");
    EXPECT_EQ(repairs[0].kept_gone, 0);
    EXPECT_NE(repairs[0].damage.find("not a database"), std::string::npos) << repairs[0].damage;
    ASSERT_EQ(set_aside().size(), 1U);
    EXPECT_EQ(repairs[0].set_aside, set_aside()[0]);
    EXPECT_EQ(read_file(set_aside()[0])->size(), noise.size())
        << "the damaged file must stay unchanged";
    EXPECT_TRUE(catalog.take_repairs().empty());
}

TEST_F(DamagedDatabase, RowsOfGoneFilesAreKeptButForThoseOfTheDamagedPage) {
    fill(0, 400);
    damage_page_with(facts_of(200).path);
    auto catalog = *CatalogWriter::open(catalog_);
    ASSERT_TRUE(catalog.list("KTLX", {}));
    const auto repairs = catalog.take_repairs();
    ASSERT_EQ(repairs.size(), 1U);
    EXPECT_GT(repairs[0].lost, 0);
    EXPECT_LT(repairs[0].lost, 80) << "only rows on one or two pages should be lost";
    EXPECT_EQ(repairs[0].kept_gone + repairs[0].lost, 400);
    EXPECT_EQ(expect_true_rows(catalog), static_cast<std::size_t>(repairs[0].kept_gone));
    EXPECT_TRUE(examine_database(database_)->damage.empty());
}

TEST_F(DamagedDatabase, RowsOfFilesThatAreThereAreLeftToBeReadAgain) {
    fs::create_directory(directory_ / "drop");
    for (int number = 300; number < 310; ++number)
        std::ofstream(facts_of(number, directory_ / "drop").path) << "x";
    fill(0, 300);
    fill(300, 310, directory_ / "drop");
    damage_page_with(facts_of(150).path);
    auto catalog = *CatalogWriter::open(catalog_);
    ASSERT_TRUE(catalog.examine("KTLX"));
    const auto repairs = catalog.take_repairs();
    ASSERT_EQ(repairs.size(), 1U);
    EXPECT_EQ(repairs[0].to_read_again, 10);
    EXPECT_EQ(expect_true_rows(catalog), static_cast<std::size_t>(repairs[0].kept_gone));
    const FileFacts again = facts_of(305, directory_ / "drop");
    EXPECT_FALSE(*catalog.is_settled(again.path, again.size_bytes, again.modified_ns));
    EXPECT_EQ(*catalog.register_file(again), Registered::added);
}

// The bytes change while the database is open, without SQLite's knowledge.
TEST_F(DamagedDatabase, DamageAtRunTimeDoesNotStopTheStation) {
    fill(0, 200);
    auto catalog = *CatalogWriter::open(catalog_);
    ASSERT_TRUE(catalog.register_file(facts_of(3000)));
    auto changed = bytes();
    std::fill(changed.begin() + page, changed.end(), std::byte{0xA5});
    overwrite(changed);
    const auto entries = catalog.list("KTLX", {});
    ASSERT_TRUE(entries) << entries.error().message;
    EXPECT_EQ(catalog.take_repairs().size(), 1U);
    EXPECT_EQ(*catalog.register_file(facts_of(3001)), Registered::added);
    EXPECT_EQ(set_aside().size(), 1U);
}

// Damages each page, in one of three ways in turn, and expects that the station can still be used.
// STORMCELLAR_CRASHES=1 damages each page in all three ways.
TEST_F(DamagedDatabase, DamageOfAnyPageIsMended) {
    const bool all_ways = std::getenv("STORMCELLAR_CRASHES") != nullptr;
    fill(0, 90);
    const auto good = bytes();
    int mended = 0;
    for (std::size_t at = 0; at < good.size(); at += page) {
        for (const std::size_t kind : {0, 1, 2}) {
            if (!all_ways && at / page % 3 != kind) continue;
            auto changed = good;
            const auto first = changed.begin() + static_cast<std::ptrdiff_t>(at);
            if (kind == 0) std::fill_n(first, page, std::byte{0});
            if (kind == 1) std::fill_n(first, 64, std::byte{0x5A});
            if (kind == 2) changed.resize(at + page / 2);
            overwrite(changed);
            auto catalog = *CatalogWriter::open(catalog_);
            ASSERT_TRUE(catalog.examine_all()) << "page " << at / page << ", kind " << kind;
            const auto repairs = catalog.take_repairs();
            mended += static_cast<int>(repairs.size());
            if (at > 0) {
                EXPECT_EQ(repairs.size(), 1U) << "page " << at / page << ", kind " << kind;
            }
            expect_true_rows(catalog);
            EXPECT_TRUE(catalog.register_file(facts_of(1000)));
        }
    }
    EXPECT_GT(mended, 8);
    EXPECT_EQ(set_aside().size(), static_cast<std::size_t>(mended))
        << "each damaged database gets its own name";
}

TEST_F(DamagedDatabase, LostIndicesAndTablesAreDamage) {
    fill(0, 20);
    const auto good = bytes();
    for (const char* drop : {"DROP INDEX volume_identity", "DROP TABLE part", "DROP TABLE file",
                             "PRAGMA user_version = 0", "PRAGMA application_id = 7"}) {
        overwrite(good);
        {
            SQLite::Database open(database_, SQLite::OPEN_READWRITE);
            open.exec(drop);
        }
        auto catalog = *CatalogWriter::open(catalog_);
        ASSERT_TRUE(catalog.examine("KTLX")) << drop;
        EXPECT_EQ(catalog.take_repairs().size(), 1U) << drop;
        EXPECT_TRUE(catalog.register_file(facts_of(100))) << drop;
    }
}

TEST_F(DamagedDatabase, AnotherStationsDamageIsMendedOnTheWay) {
    fs::create_directory(catalog_);
    std::ofstream(catalog_ / "KAAA.sqlite") << std::string(5000, 'x');
    auto catalog = *CatalogWriter::open(catalog_);
    EXPECT_EQ(*catalog.register_file(facts_of(1)), Registered::added);
    EXPECT_EQ(*catalog.mark_gone(facts_of(1).path), 1);
    EXPECT_LE(catalog.take_repairs().size(), 1U);
    FileFacts its_own = facts_of(2);
    its_own.station = "KAAA";
    EXPECT_EQ(*catalog.register_file(its_own), Registered::added);
}

TEST_F(DamagedDatabase, ADatabaseThatIsDeletedUnderTheWriterIsMadeAgain) {
    auto catalog = *CatalogWriter::open(catalog_);
    ASSERT_TRUE(catalog.register_file(facts_of(1)));
    fs::remove(database_);
    EXPECT_EQ(*catalog.register_file(facts_of(2)), Registered::added);
    const auto repairs = catalog.take_repairs();
    ASSERT_EQ(repairs.size(), 1U) << "a repair must be reported, so that files are offered again";
    EXPECT_TRUE(repairs[0].set_aside.empty());
    auto reader = *CatalogReader::open(catalog_);
    EXPECT_EQ(reader.list("KTLX", {})->size(), 1U);
}

// A repair first writes the new database, so the old or the new database exists after each later
// step.
TEST_F(DamagedDatabase, ARepairThatWasCutShortIsFinishedOrBegunAgain) {
    fill(0, 200);
    damage_page_with(facts_of(100).path);
    const fs::path mending = database_.native() + ".mending";
    std::ofstream(mending) << "half";  // an unfinished new database
    {
        auto catalog = *CatalogWriter::open(catalog_);
        ASSERT_TRUE(catalog.examine("KTLX"));
        EXPECT_GT(expect_true_rows(catalog), 100U);
    }
    EXPECT_FALSE(fs::exists(mending));
    // The damaged database was set aside, but not its WAL, and the new database is not yet in its
    // place.
    fs::rename(database_, mending);
    std::ofstream(database_.native() + "-wal") << "the damaged one's";
    auto catalog = *CatalogWriter::open(catalog_);
    ASSERT_TRUE(catalog.register_file(facts_of(500)));
    EXPECT_GT(catalog.list("KTLX", {})->size(), 100U);
    EXPECT_FALSE(fs::exists(mending));
}

TEST_F(DamagedDatabase, GenerationsAndSeveralVolumesOfAFileAreKept) {
    {
        auto catalog = *CatalogWriter::open(catalog_);
        FileFacts first = facts_of(1), second = facts_of(1);
        second.path = "/gone/KTLX-000002";
        second.content_hash = 99;
        second.volumes.push_back(facts_of(7).volumes[0]);
        ASSERT_TRUE(catalog.register_file(first));
        ASSERT_TRUE(catalog.register_file(second));
    }
    {
        SQLite::Database open(database_, SQLite::OPEN_READWRITE);
        open.exec("DROP INDEX part_volume");
    }
    auto catalog = *CatalogWriter::open(catalog_);
    ASSERT_TRUE(catalog.examine_all());
    const auto entries = *catalog.list("KTLX", {});
    ASSERT_EQ(entries.size(), 3U);
    EXPECT_EQ(entries[0].generation, 0);
    EXPECT_EQ(entries[1].generation, 1);
    EXPECT_EQ(entries[2].volume.volume_number, 7);
}

}  // namespace
}  // namespace stormcellar::catalog
