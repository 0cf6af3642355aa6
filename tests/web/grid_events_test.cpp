// Tests the events for changes in the cache: grids of sites, mosaics, evicted grids, old news.
#include "web/data/events/grid_events.h"

#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "stormcellar/cache/store.h"
#include "tests/cache/made_grids.h"
#include "tests/testing/temporary_directory.h"
#include "tests/testing/waiting.h"

namespace stormcellar::web {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;
using testing::noon;

class EventsOfGrids : public ::testing::Test {
  protected:
    EventsOfGrids() {
        grids_->listen([this](const CacheChange& change) { changes_.push_back(change); });
    }
    std::vector<json> events() {
        (void)grids_->changes();  // catches up
        std::vector<json> jsons;
        for (const Event& event : grid_events_.of(std::exchange(changes_, {}), noon + 1h))
            jsons.push_back(json::parse(event.json));
        return jsons;
    }
    static std::vector<std::string> types(const std::vector<json>& events) {
        std::vector<std::string> names;
        for (const json& event : events)
            names.push_back(event["type"]);
        return names;
    }
    void commit_frame(int revision, bool is_provisional) {
        cache::GridDescription about = testing::sized_description(noon);
        about.sites.push_back({"KOKX", 40.87, -72.86, 26});
        about.provenance.stations = {"KBGM", "KOKX"};
        about.provenance.revision = revision;
        about.provenance.provisional = is_provisional;
        ASSERT_TRUE(store_.commit("northeast", about, testing::sized_grid(2).view()));
    }
    void evict(const std::string& domain) {
        const auto entries = *store_.list(domain, level2::Moment::ref, {}, {});
        for (const auto& entry : entries)
            ASSERT_TRUE(store_.remove(entry));
    }
    using Types = std::vector<std::string>;

    testing::TemporaryDirectory directory_;
    cache::StoreWriter store_ =
        *cache::StoreWriter::open(real_file_system(), directory_ / "cache", false);
    std::vector<CacheChange> changes_;
    std::shared_ptr<Grids> grids_ = *Grids::open({.cache = directory_ / "cache"});
    StationNews book_{20min};
    GridEvents grid_events_{grids_, book_, file_clock_ns()};
};

TEST_F(EventsOfGrids, AGridOfASiteIsAVolume) {
    ASSERT_TRUE(testing::commit_sized(store_, "KBGM", noon));
    const auto all = events();
    ASSERT_EQ(types(all), (Types{"volume_begun", "volume_complete"}));
    EXPECT_EQ(all[0]["volume"], "2024-11-22T12:00:00Z");
    const json& event = all[1];
    EXPECT_EQ(event["station"], "KBGM");
    EXPECT_EQ(event["moment"], "REF");
    EXPECT_EQ(event["grid"], "2024-11-22T12:00:00Z");
    EXPECT_EQ(event["path"], "/api/v1/grids/KBGM/REF/2024-11-22T12:00:00Z");
    EXPECT_EQ(event["partial"], false);
    const auto grid = grids_->find("KBGM", level2::Moment::ref, noon);
    EXPECT_EQ(event["id"], (*grid)->id) << "the API gives the same id";
}

TEST_F(EventsOfGrids, AGridThatIsMadeAgainIsToldAgain) {
    ASSERT_TRUE(testing::commit_sized(store_, "KBGM", noon, 2, 1));
    const auto first = events();
    ASSERT_TRUE(testing::commit_sized(store_, "KBGM", noon, 3, 2));
    const auto second = events();
    ASSERT_EQ(types(second), Types{"volume_complete"});
    EXPECT_NE(second[0]["id"], first.back()["id"]);
    ASSERT_TRUE(testing::commit_sized(store_, "KBGM", noon, 4, 3));
    ASSERT_TRUE(testing::commit_sized(store_, "KBGM", noon, 5, 4));
    EXPECT_EQ(types(events()), Types{"volume_complete"}) << "the last change counts";
}

TEST_F(EventsOfGrids, AFrameOfADomainIsAMosaicAndItsPartsAreNobodysBusiness) {
    commit_frame(1, true);
    ASSERT_TRUE(testing::commit_sized(store_, "northeast.KBGM", noon));
    auto all = events();
    ASSERT_EQ(types(all), Types{"mosaic"});
    EXPECT_FALSE(all[0].contains("station"));
    EXPECT_EQ(all[0]["domain"], "northeast");
    EXPECT_EQ(all[0]["provisional"], true);
    EXPECT_EQ(all[0]["revision"], 1);
    EXPECT_EQ(all[0]["stations"], (json{"KBGM", "KOKX"}));
    commit_frame(2, false);
    all = events();
    ASSERT_EQ(types(all), Types{"mosaic"});
    EXPECT_EQ(all[0]["provisional"], false);
    EXPECT_EQ(all[0]["revision"], 2);
    evict("northeast.KBGM");
    EXPECT_EQ(types(events()), Types{});
    EXPECT_TRUE(book_.pages().empty()) << "a mosaic does not show that a station is alive";
}

TEST_F(EventsOfGrids, EvictedGridsAreOneEventOfAMoment) {
    for (int i = 0; i < 3; ++i)
        ASSERT_TRUE(testing::commit_sized(store_, "KBGM", noon + i * 5min, 1));
    (void)events();
    auto entries = *store_.list("KBGM", level2::Moment::ref, {}, {});
    ASSERT_TRUE(store_.remove(entries[1]) && store_.remove(entries[0]));
    auto all = events();
    ASSERT_EQ(types(all), Types{"grid_evicted"});
    EXPECT_EQ(all[0]["station"], "KBGM");
    EXPECT_EQ(all[0]["count"], 2);
    EXPECT_EQ(all[0]["grids"], (json{"2024-11-22T12:00:00Z", "2024-11-22T12:05:00Z"}));
    EXPECT_EQ(all[0]["oldest"], "2024-11-22T12:10:00Z");
    ASSERT_TRUE(store_.remove(entries[2]));
    all = events();
    ASSERT_EQ(types(all), Types{"grid_evicted"});
    EXPECT_TRUE(all[0]["oldest"].is_null()) << "no grid is left";
}

TEST_F(EventsOfGrids, AGridThatCameAndWentIsToldAsGone) {
    const auto next_told = [&] {
        Types told;
        (void)testing::eventually([&] { return !(told = types(events())).empty(); });
        return told;
    };
    // The directories are watched from their first grid on.
    ASSERT_TRUE(testing::commit_sized(store_, "KBGM", noon - 5min));
    ASSERT_FALSE(next_told().empty());
    ASSERT_TRUE(testing::commit_sized(store_, "KBGM", noon));
    const auto entries = *store_.list("KBGM", level2::Moment::ref, noon, noon);
    ASSERT_TRUE(store_.remove(entries.front()));
    EXPECT_EQ(next_told(), Types{"grid_evicted"});
}

TEST_F(EventsOfGrids, WhatLayThereBeforeIsNoNews) {
    ASSERT_TRUE(testing::commit_sized(store_, "KBGM", noon));
    const auto path = *store_.path_of("KBGM", level2::Moment::ref, noon);
    const auto ref = CacheChange{CacheEvent::changed, {"KBGM", level2::Moment::ref, noon}};
    (void)events();
    changes_ = {ref};
    EXPECT_EQ(types(events()), Types{}) << "a grid with these bytes was already reported";
    GridEvents later(grids_, book_, file_clock_ns() + 1'000'000'000);
    const std::vector<CacheChange> changes{ref};
    EXPECT_TRUE(later.of(changes, noon).empty())
        << "the grid was written before the later server began";
    const std::vector<CacheChange> came{{CacheEvent::came, ref.grid}};
    const auto back = later.of(came, noon);
    ASSERT_EQ(back.size(), 1u) << "a disk was mounted, so clients must request their lists again";
    EXPECT_EQ(back[0].type, EventType::reset);
}

TEST_F(EventsOfGrids, WhatTheKernelLostIsAReset) {
    changes_ = {{CacheEvent::everything, {}}};
    EXPECT_EQ(types(events()), Types{"reset"});
}

TEST_F(EventsOfGrids, AGridThatCannotBeReadIsCountedAndToldOnceItCan) {
    const auto path = *store_.path_of("KBGM", level2::Moment::ref, noon);
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << "no grid";
    EXPECT_EQ(types(events()), Types{});
    EXPECT_EQ(grid_events_.unreadable(), 1u);
    ASSERT_TRUE(testing::commit_sized(store_, "KBGM", noon));
    const auto all = events();
    ASSERT_FALSE(all.empty());
    EXPECT_EQ(all.back()["type"], "volume_complete");
}

}  // namespace
}  // namespace stormcellar::web
