// Tests that invented stations get no database, and that the databases of an earlier attack stay
// closed.
#include <chrono>
#include <fstream>
#include <set>

#include <gtest/gtest.h>

#include "catalog/path_homes.h"
#include "tests/catalog/catalog_fixture.h"

namespace stormcellar::catalog {
namespace {

class KnownStations : public ::testing::Test {
  protected:
    CatalogWriter open(StationRule rule = {}) {
        CatalogOptions options;
        options.stations = rule_ = std::make_shared<StationRule>(std::move(rule));
        return *CatalogWriter::open(catalog_, options);
    }
    // Leaves a database of an older configuration, which accepted every name.
    void put(const std::string& station, std::chrono::minutes age = {}) {
        {
            auto catalog = *CatalogWriter::open(catalog_);
            ASSERT_TRUE(catalog.register_file(file("/d/" + station + "_a", {}, station)));
        }
        const fs::path database = catalog_ / (station + ".sqlite");
        fs::last_write_time(database, fs::file_time_type::clock::now() - age);
    }
    std::set<std::string> databases() {
        std::set<std::string> names;
        for (const auto& entry : fs::directory_iterator(catalog_)) {
            if (entry.path().extension() == ".sqlite") names.insert(entry.path().stem());
        }
        return names;
    }
    testing::TemporaryDirectory directory_;
    fs::path catalog_ = directory_ / "catalog";
    std::shared_ptr<StationRule> rule_;
};

// 2026-11-24: 1,356 files with invented names got a database each, until no descriptor was left.
TEST_F(KnownStations, FilesOfInventedStationsStandTogether) {
    auto catalog = open();
    for (int k = 0; k < 50; ++k) {
        const std::string station = fmt::format("X{:03}", k);
        const std::string path = "/d/" + station + "_a";
        EXPECT_FALSE(*catalog.is_known(path));
        ASSERT_TRUE(catalog.note_file(file(path, {}, station)));
        EXPECT_EQ(*catalog.register_file(file(path, {}, station)), Registered::unchanged);
        ASSERT_TRUE(catalog.register_files(station, {file(path + "b", {}, station)}));
        EXPECT_TRUE(*catalog.is_settled(path, 1000, 42));
        EXPECT_EQ(catalog.list(station, {}).error().code, ErrorCode::not_found);
    }
    ASSERT_TRUE(catalog.register_file(file("/d/KTLX_a", {}, "KTLX")));
    EXPECT_EQ(databases(), (std::set<std::string>{"KTLX", "_unknown"}));
    EXPECT_EQ(catalog.open_databases(), 2U);
    EXPECT_EQ(catalog.list("", {{}, {}, true})->size(), 100U);
    EXPECT_EQ(*catalog.mark_gone("/d/X007_a"), 1);
}

TEST_F(KnownStations, DatabasesOfOtherStationsAreLeftAlone) {
    for (int k = 0; k < 9; ++k)
        put(fmt::format("X{:03}", k));
    put("KTLX");
    std::ofstream(catalog_ / "XBAD.sqlite") << std::string(5000, 'x');
    auto catalog = open();
    EXPECT_EQ(*catalog.station_names(), std::vector<std::string>{"KTLX"});
    EXPECT_FALSE(*catalog.is_known("/d/X001_a"));
    EXPECT_EQ(catalog.stations()->size(), 1U);
    EXPECT_TRUE(catalog.examine_all());
    EXPECT_EQ(*catalog.mark_missing("/d"), 1) << "only the row of KTLX is marked";
    EXPECT_EQ(*catalog.forget_gone(now_utc() + std::chrono::hours{1}), 1);
    EXPECT_TRUE(catalog.roll());
    EXPECT_TRUE(catalog.take_repairs().empty());
    EXPECT_TRUE(catalog.troubles().empty());
    EXPECT_EQ(catalog.open_databases(), 1U);
    const auto left = catalog.left_alone();
    ASSERT_TRUE(left);
    EXPECT_EQ(left->count, 10U);
    EXPECT_EQ(left->some, (std::vector<std::string>{"X000", "X001", "X002", "X003", "X004"}));
    EXPECT_EQ(databases().size(), 11U) << "the databases must stay";
    EXPECT_EQ(open(StationRule::listed({"X001"})).left_alone()->count, 10U);
    // A reader without a rule sees all stations.
    EXPECT_EQ(CatalogReader::open(catalog_)->stations()->size(), 10U);
}

TEST_F(KnownStations, AnyAdmitsFirstWhatHasADatabaseAndTheNewestFirst) {
    put("XOLD", std::chrono::minutes{30});
    put("XNEW", std::chrono::minutes{10});
    put("XMID", std::chrono::minutes{20});
    auto catalog = open(StationRule::any(2));
    EXPECT_EQ(rule_->further(), (std::vector<std::string>{"XMID", "XNEW"}));
    EXPECT_EQ(*catalog.station_names(), (std::vector<std::string>{"XMID", "XNEW"}));
    EXPECT_EQ(catalog.left_alone()->some, std::vector<std::string>{"XOLD"});
    ASSERT_TRUE(catalog.register_file(file("/d/x", {}, "XOLD")));
    EXPECT_EQ(catalog.list("", {{}, {}, true})->size(), 1U);
}

// A file that was noted before its station was admitted is still found among the files of unknown
// stations.
TEST_F(KnownStations, AStationThatIsAdmittedLaterFindsItsFiles) {
    auto catalog = open(StationRule::any(2));
    ASSERT_TRUE(catalog.register_file(file("/d/XABC_a", {}, "XABC")));
    for (int path = 0; path < 70'000; ++path)  // more paths than are remembered
        ASSERT_FALSE(*catalog.is_known("/other/" + std::to_string(path)));
    ASSERT_TRUE(rule_->admits("XABC"));
    EXPECT_TRUE(*catalog.is_settled("/d/XABC_a", 1000, 42));
    ASSERT_TRUE(catalog.register_file(file("/d/XABC_a", {}, "XABC")));
    EXPECT_TRUE(catalog.list("", {{}, {}, true})->empty());
    EXPECT_EQ(catalog.list("XABC", {{}, {}, true})->size(), 1U);
}

TEST(GuessedHome, NamesThatTheRuleDoesNotKnowSayNothing) {
    const StationRule known;
    EXPECT_EQ(guessed_home("/d/KTLX20220317", &known), "KTLX");
    EXPECT_EQ(guessed_home("/d/KTLX/XABC20220317", &known), "KTLX");
    EXPECT_EQ(guessed_home("/d/XABC20220317", &known), unknown_station);
    EXPECT_EQ(guessed_home("/d/XABC20220317"), "XABC");
}

}  // namespace
}  // namespace stormcellar::catalog
