// Tests a box over several sites: its plan, its cells, and the answers of the API.
#include "web/data/grids/region.h"

#include <cmath>
#include <cstring>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "stormcellar/base/station_table.h"
#include "stormcellar/cache/store.h"
#include "stormcellar/grid/projection.h"
#include "tests/cache/made_grids.h"
#include "tests/grid/moving_blobs.h"
#include "tests/testing/temporary_directory.h"
#include "tests/web/asked.h"
#include "web/data/grids/packed_grid.h"
#include "web/data/raw/raw_files.h"
#include "web/doors/api/door.h"

namespace stormcellar::web {
namespace {

using Json = nlohmann::json;

constexpr int side = 160;  // columns of 2 km
constexpr float value_of_kbgm = 20, value_of_kccx = 40;

// Returns a grid with one value within 150 km of the site, and no echo beyond.
grid::Grid grid_at(const char* icao, const grid::GeoPoint& place, float value, UtcTime time) {
    grid::Grid made;
    made.spec.center_latitude_deg = place.latitude_deg;
    made.spec.center_longitude_deg = place.longitude_deg;
    made.spec.spacing_m = 2000;
    made.spec.nx = made.spec.ny = side;
    made.spec.levels_m = {1000, 2000, 3000};
    made.time = made.start_time = time;
    made.end_time = time + std::chrono::minutes{4};
    made.sites = {{icao, place.latitude_deg, place.longitude_deg, 300}};
    made.values.assign(made.spec.cell_count(), 0);
    made.status.assign(made.spec.cell_count(), grid::CellStatus::no_echo);
    for (int iy = 0; iy < side; ++iy) {
        for (int ix = 0; ix < side; ++ix) {
            if (std::hypot(made.spec.x_m(ix), made.spec.y_m(iy)) >= 150'000) continue;
            for (int iz = 0; iz < 3; ++iz) {
                made.values[made.spec.index(ix, iy, iz)] = value;
                made.status[made.spec.index(ix, iy, iz)] = grid::CellStatus::value;
            }
        }
    }
    return made;
}

grid::Grid grid_of(const char* icao, float value, UtcTime time) {
    const Station station = *find_station(icao);
    return grid_at(icao, {station.latitude_deg, station.longitude_deg}, value, time);
}

class Region : public ::testing::Test {
  protected:
    Region() {
        commit(grid_of("KBGM", value_of_kbgm, testing::noon));
        commit(grid_of("KCCX", value_of_kccx, testing::noon + std::chrono::minutes{6}));
        commit(grid_of("KTLX", 50, testing::noon));  // far away
        grids_ = *Grids::open({.cache = directory_ / "cache"});
        door_ = std::make_unique<ApiDoor>(
            ApiSources{.grids = grids_,
                       .catalog = {},
                       .kept = std::make_shared<KeptAnswers>(std::uint64_t{16} << 20)});
    }
    void commit(const grid::Grid& made) {
        const auto quantization = grid::default_quantization(level2::Moment::ref);
        ASSERT_TRUE(store_.commit(made.sites.front().icao, cache::describe(made),
                                  grid::BrickGrid::from(made, quantization).view()));
    }
    Json json(const std::string& target, unsigned status = 200) {
        const Answer answer = asked(*door_, target);
        EXPECT_EQ(answer.status, status) << target << body_of(answer);
        return Json::parse(body_of(answer));
    }
    RegionPlan plan(const RegionBox& box) {
        auto made = plan_region(*grids_, box, level2::Moment::ref);
        EXPECT_TRUE(made) << (made ? "" : made.error().message);
        return made ? *made : RegionPlan{};
    }

    testing::TemporaryDirectory directory_;
    cache::StoreWriter store_ =
        *cache::StoreWriter::open(real_file_system(), directory_ / "cache", false);
    std::shared_ptr<Grids> grids_;
    std::unique_ptr<ApiDoor> door_;
};

constexpr RegionBox both{-78.8, 40.3, -75, 42.9};
constexpr const char* both_query = "/api/v1/regions?west=-78.8&south=40.3&east=-75&north=42.9";

float value_at(const grid::BrickView& view, double latitude, double longitude) {
    const auto at = grid::GridProjection(*view.spec).to_column({latitude, longitude});
    const int x = static_cast<int>(std::lround(at.x)), y = static_cast<int>(std::lround(at.y));
    EXPECT_EQ(view.status(x, y, 1), grid::CellStatus::value);
    return view.value(x, y, 1);
}

TEST_F(Region, HasTheSitesThatReachIt) {
    const RegionPlan made = plan(both);
    EXPECT_EQ(made.sites, (std::vector<std::string>{"KBGM", "KCCX"}));
    EXPECT_EQ(made.halvings, 0);
    EXPECT_EQ(made.spec.spacing_m, 2000);
    EXPECT_EQ(made.spec.levels_m, (std::vector<double>{1000, 2000, 3000}));
    // The grid covers the corners of the box, and little more.
    const grid::GridProjection plane(made.spec);
    for (const double latitude : {both.south_deg, both.north_deg}) {
        for (const double longitude : {both.west_deg, both.east_deg}) {
            const auto at = plane.to_column({latitude, longitude});
            EXPECT_TRUE(at.x > -1 && at.x < made.spec.nx && at.y > -1 && at.y < made.spec.ny);
        }
    }
    EXPECT_LT(made.spec.nx * 2.0, 340);
    EXPECT_EQ(plan({-75.2, 43.2, -75.0, 43.4}).sites, (std::vector<std::string>{"KBGM"}));
}

TEST_F(Region, CellsAreThoseOfTheSitesAndMixBetweenThem) {
    const auto frame = make_region(*grids_, plan(both), testing::noon + std::chrono::minutes{5});
    ASSERT_TRUE(frame) << frame.error().message;
    const grid::BrickView view = frame->mosaic.cells.view();
    EXPECT_EQ(value_at(view, 42.2, -75.9), value_of_kbgm);
    EXPECT_EQ(value_at(view, 40.9, -78.1), value_of_kccx);
    // If both sites see echo, the cell is a mean with weights by distance.
    const float between = value_at(view, 41.56, -77.0);
    EXPECT_GT(between, value_of_kbgm + 5);
    EXPECT_LT(between, value_of_kccx - 5);
    EXPECT_EQ(frame->description.sites.size(), 2u);
}

TEST_F(Region, TakesVolumesNearTheInstantAlone) {
    const RegionPlan made = plan(both);
    const auto times = region_times(*grids_, made);
    EXPECT_EQ(times,
              (std::vector<UtcTime>{testing::noon, testing::noon + std::chrono::minutes{5}}));
    commit(grid_of("KBGM", value_of_kbgm, testing::noon + std::chrono::minutes{14}));
    grids_->refresh();
    EXPECT_EQ(region_times(*grids_, made).size(), 4u)
        << "instants between two volumes of a site are included";
    const auto late = make_region(*grids_, made, testing::noon + std::chrono::hours{2});
    ASSERT_FALSE(late);
    EXPECT_EQ(late.error().code, ErrorCode::not_found);
}

// Two volumes, with middles at 12:02 and 12:08, show an echo that moves at 20 m/s. At 12:05 the
// echo is halfway between; one volume alone would show the echo 3.6 km from this place.
TEST_F(Region, EchoIsMovedToTheInstant) {
    const std::vector<grid::Blob> blobs = {
        {-60, -40, 25, 55, 20, 5}, {30, 50, 20, 50, 20, 5}, {60, -50, 30, 45, 20, 5}};
    const auto at = [&](int seconds) {
        grid::Grid made = grid_of("KMLB", 0, testing::noon + std::chrono::seconds{seconds});
        const grid::Grid echo = grid::blob_grid(made.spec, blobs, seconds + 120, 160);
        made.values = echo.values;
        made.status = echo.status;
        return made;
    };
    commit(at(0));
    commit(at(360));
    grids_->refresh();
    const Station station = *find_station("KMLB");
    const RegionPlan made = plan({station.longitude_deg - 1, station.latitude_deg - 0.8,
                                  station.longitude_deg + 1, station.latitude_deg + 0.8});
    ASSERT_EQ(made.sites, std::vector<std::string>{"KMLB"}) << "no other site reaches the box";
    const UtcTime instant = testing::noon + std::chrono::minutes{5};
    const auto frame = make_region(*grids_, made, instant);
    ASSERT_TRUE(frame) << frame.error().message;
    const grid::BrickView view = frame->mosaic.cells.view();
    const auto rms_against = [&](double t_s) {
        double squares = 0;
        int cells = 0;
        for (int iy = 0; iy < made.spec.ny; ++iy) {
            for (int ix = 0; ix < made.spec.nx; ++ix) {
                const double x_km = made.spec.x_m(ix) / 1000, y_km = made.spec.y_m(iy) / 1000;
                const double truth = grid::blobs_dbz(blobs, x_km, y_km, t_s);
                if (truth < 20) continue;
                EXPECT_EQ(view.status(ix, iy, 1), grid::CellStatus::value);
                squares += std::pow(static_cast<double>(view.value(ix, iy, 1)) - truth, 2);
                ++cells;
            }
        }
        EXPECT_GT(cells, 500);
        return std::sqrt(squares / cells);
    };
    EXPECT_LT(rms_against(300), 1);
    EXPECT_GT(rms_against(480), 2) << "the place of the echo without motion";
    const auto sites = region_sites(*grids_, made, instant);
    ASSERT_TRUE(sites);
    ASSERT_EQ(sites->size(), 1u);
    EXPECT_EQ(RegionSite::seconds_to(*sites->front().before, instant), -180);
    EXPECT_EQ(RegionSite::seconds_to(*sites->front().after, instant), 180);
}

// The plan has the levels of the newest grids; an older grid has fewer levels.
TEST_F(Region, LeavesOutAnOlderGridOfOtherLevels) {
    const UtcTime earlier = testing::noon - std::chrono::hours{3};
    grid::Grid low = grid_of("KBGM", value_of_kbgm, earlier);
    low.spec.levels_m = {1000};
    low.values.resize(low.spec.cell_count());
    low.status.resize(low.spec.cell_count());
    commit(low);
    grids_->refresh();
    const auto alone = make_region(*grids_, plan(both), earlier);
    ASSERT_FALSE(alone);
    EXPECT_EQ(alone.error().code, ErrorCode::not_found);
    commit(grid_of("KCCX", value_of_kccx, earlier));
    grids_->refresh();
    const auto other = make_region(*grids_, plan(both), earlier);
    ASSERT_TRUE(other) << other.error().message;
    EXPECT_EQ(other->description.sites.size(), 1u);
}

TEST_F(Region, LargeOnesAreCoarserAndLargerOnesRefused) {
    EXPECT_EQ(plan({-95, 30, -70, 48}).halvings, 1);
    const auto far_too_large = region_box_of("-100,20,-50,50");
    ASSERT_FALSE(far_too_large);
    EXPECT_EQ(far_too_large.error().code, ErrorCode::bad_argument);
}

// 2026-11-28: a comma after the last number was accepted, so links could have more text after it.
TEST_F(Region, ItsNameIsFourNumbersAndNothingElse) {
    EXPECT_TRUE(region_box_of("-80,40,-75,43"));
    for (const char* name : {"-80,40,-75,43,", "-80,40,-75,43,1", "-80,40,-75", "-80,40,-75,", ""})
        EXPECT_FALSE(region_box_of(name)) << name;
}

TEST_F(Region, TheApiNamesSitesTimesAndPathsAndPacksThem) {
    const Json region = json(both_query);
    EXPECT_EQ(region["domain"], "region:-78.8,40.3,-75,42.9");
    ASSERT_EQ(region["moments"].size(), 1u);
    const Json& ref = region["moments"][0];
    EXPECT_EQ(ref["moment"], "REF");
    EXPECT_EQ(ref["sites"], (Json{"KBGM", "KCCX"}));
    EXPECT_EQ(ref["times"], (Json{"2024-11-22T12:00:00Z", "2024-11-22T12:05:00Z"}));
    const std::string path = ref["path"].get<std::string>() + "/2024-11-22T12:05:00Z/packed";
    const Answer packed = asked(*door_, path);
    ASSERT_EQ(packed.status, 200u) << body_of(packed);
    const std::string bytes = body_of(packed);
    PackedHeader header;
    std::memcpy(&header, bytes.data(), sizeof header);
    EXPECT_EQ(header.magic, packed_magic);
    EXPECT_EQ(header.size, bytes.size());
    EXPECT_EQ(header.nx, ref["nx"]);
    EXPECT_EQ(header.site_count, 2u);
    // The door keeps the first answer and gives it again, until a grid of a site changes.
    EXPECT_EQ(body_of(asked(*door_, path)), bytes);
    commit(grid_of("KBGM", 30, testing::noon));
    grids_->refresh();
    EXPECT_NE(body_of(asked(*door_, path)), bytes);
}

// 2026-11-28: a volume with a date in the future was the newest, with an age of minus half a year.
TEST_F(Region, ATimeOfTheFutureIsNotTheNewest) {
    commit(grid_of("KBGM", 30, now_utc() + std::chrono::days{180}));
    grids_->refresh();
    const Json ref = json(both_query)["moments"][0];
    EXPECT_EQ(ref["times"].size(), 3u);
    EXPECT_EQ(ref["newest"], "2024-11-22T12:05:00Z");
    EXPECT_GT(ref["age_s"], 0);
}

TEST_F(Region, TheApiSaysOfWhichVolumesEachSiteIsMade) {
    const Json instant = json("/api/v1/regions/-78.8,40.3,-75,42.9/REF/2024-11-22T12:05:00Z/sites");
    EXPECT_EQ(instant["time"], "2024-11-22T12:05:00Z");
    EXPECT_EQ(instant["sites"],
              (Json{{{"site", "KBGM"},
                     {"volumes", {{{"time", "2024-11-22T12:00:00Z"}, {"middle_s", -180}}}}},
                    {{"site", "KCCX"},
                     {"volumes", {{{"time", "2024-11-22T12:06:00Z"}, {"middle_s", 180}}}}}}));
    EXPECT_EQ(instant["left_out_because"], Json::object());
    json("/api/v1/regions/-78.8,40.3,-75,42.9/REF/soon/sites", 404);
}

// 2026-11-28: the API gave the same reason for every site that was not in the picture.
TEST_F(Region, TheApiSaysWhyASiteIsNotInThePicture) {
    grid::Grid low = grid_of("KBGM", value_of_kbgm, testing::noon - std::chrono::hours{3});
    low.spec.levels_m = {1000};
    low.values.resize(low.spec.cell_count());
    low.status.resize(low.spec.cell_count());
    commit(low);
    grids_->refresh();
    const Json earlier = json("/api/v1/regions/-78.8,40.3,-75,42.9/REF/2024-11-22T09:00:00Z/sites");
    EXPECT_EQ(earlier["sites"], Json::array());
    EXPECT_EQ(earlier["left_out_because"],
              (Json{{"KBGM", "its grids of this time have other levels or codes"},
                    {"KCCX", "it has no volume within 15 minutes"}}));
}

// 2026-11-28: a radar whose place is known only from its file was in no region and in no list.
TEST_F(Region, ARadarThatItsFilePlacesIsThere) {
    commit(grid_at("ROP4", {35.24, -97.46}, 40, testing::noon));
    grids_->refresh();
    const Json alone = json("/api/v1/regions?west=-97.6&south=35.1&east=-97.3&north=35.4");
    EXPECT_EQ(alone["moments"][0]["sites"], (Json{"KTLX", "ROP4"}));
    const Json stations = json("/api/v1/stations?station=ROP4")["stations"];
    ASSERT_EQ(stations.size(), 1u);
    EXPECT_EQ(stations[0]["latitude_deg"], 35.24);
    EXPECT_EQ(stations[0]["longitude_deg"], -97.46);
    EXPECT_EQ(stations[0]["antenna_altitude_m"], 300);
    EXPECT_FALSE(stations[0].contains("name"));
    const RawStation raw = raw_station("ROP4", grids_.get());
    EXPECT_TRUE(raw.has_place);
    EXPECT_EQ(raw.longitude_deg, -97.46);
    EXPECT_FALSE(raw_station("ROP5", grids_.get()).has_place);
}

TEST_F(Region, EachSiteThatIsLeftOutHasAReason) {
    grid::Grid low = grid_at("ROP4", {41.6, -77}, 40, testing::noon);
    low.spec.levels_m = {1000};
    low.values.resize(low.spec.cell_count());
    low.status.resize(low.spec.cell_count());
    commit(low);
    grid::Grid other = grid_at("ROP5", {41.7, -77}, 10, testing::noon);
    other.moment = level2::Moment::sw;
    ASSERT_TRUE(store_.commit(
        "ROP5", cache::describe(other),
        grid::BrickGrid::from(other, grid::default_quantization(level2::Moment::sw)).view()));
    grids_->refresh();
    for (const Json& moment : json(both_query)["moments"]) {
        if (moment["moment"] != "REF") continue;
        EXPECT_EQ(moment["left_out"], (Json{"ROP4", "ROP5"}));
        EXPECT_EQ(moment["left_out_because"],
                  (Json{{"ROP4", "its grids have other levels or codes than those of KBGM"},
                        {"ROP5", "it has no grids of REF"}}));
    }
}

// 2026-11-28: a box across the antimeridian was refused unless its east side was beyond 180.
TEST_F(Region, MayLieAcrossTheAntimeridian) {
    commit(grid_at("ROP4", {52, 179.9}, 40, testing::noon));
    grids_->refresh();
    for (const char* sides : {"west=178&east=-178", "west=178&east=182", "west=-182&east=-178"}) {
        const Json region = json(std::string("/api/v1/regions?") + sides + "&south=51&north=53");
        EXPECT_EQ(region["region"], "178,51,182,53") << sides;
        EXPECT_EQ(region["moments"][0]["sites"], (Json{"ROP4"}));
    }
    const std::string later = "/REF/2024-11-22T12:00:00Z/packed";
    const Answer packed = asked(*door_, "/api/v1/regions/178,51,182,53" + later);
    EXPECT_EQ(packed.status, 200u);
    EXPECT_EQ(body_of(asked(*door_, "/api/v1/regions/178,51,-178,53" + later)), body_of(packed));
}

TEST_F(Region, ErrorsSayWhatIsWrong) {
    for (const char* query : {"west=-75&south=40&east=-78&north=42", "west=-75&south=40&east=-74"})
        EXPECT_GT(json(std::string("/api/v1/regions?") + query, 400)["error"].get<std::string>(),
                  "");
    EXPECT_EQ(json("/api/v1/regions?west=10&south=40&east=12&north=42", 404)["error"],
              "no site with grids of REF reaches this region");
    for (const char* region : {"a,b,c,d", "-78,40,-75", "-78,40,-75,42,7", "-78,40,-75,nan"})
        EXPECT_EQ(json(std::string("/api/v1/regions/") + region + "/REF/latest/packed", 400).size(),
                  1u);
    json("/api/v1/regions/-78.8,40.3,-75,42.9/XYZ/2024-11-22T12:05:00Z/packed", 404);
    json("/api/v1/regions/-78.8,40.3,-75,42.9/REF/2024-11-22T18:00:00Z/packed", 404);
}

}  // namespace
}  // namespace stormcellar::web
