// Tests the operations that return storms: GeoJSON of cells and of rotation.
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "stormcellar/grid/site_frame.h"
#include "tests/testing/data.h"
#include "tests/web/pictured_storm.h"
#include "tests/web/served_storms.h"

namespace stormcellar::web {
namespace {

using nlohmann::json;
using testing::noon;

class ApiStorms : public ::testing::Test {
  protected:
    Answer get(std::string_view target, Fields headers = {}) {
        return asked(served_.api(), target, std::move(headers));
    }
    json geojson(std::string_view target) {
        const Answer answer = get(target);
        EXPECT_EQ(answer.status, 200U) << body_of(answer);
        EXPECT_EQ(header_of(answer, "Content-Type"), "application/geo+json");
        json all = json::parse(body_of(answer));
        EXPECT_EQ(all["type"], "FeatureCollection");
        return all;
    }
    static std::vector<std::string> kinds(const json& all) {
        std::vector<std::string> names;
        for (const json& feature : all["features"])
            names.push_back(feature["properties"]["kind"]);
        return names;
    }
    // Adds a vortex of this shear, in 0.001/s, `x_km` east of the center, from 1 to 5 km.
    void add_vortex(float shear, int x_km, bool is_audited) {
        grid::Grid made = storm_grid(noon, 0);
        made.moment = level2::Moment::azsh;
        made.status.assign(made.status.size(), grid::CellStatus::no_echo);
        for (int level = 1; level < 10; ++level) {
            const std::size_t at = made.spec.index(60 + x_km, 60, level);
            made.status[at] = grid::CellStatus::value;
            made.values[at] = shear;
        }
        if (is_audited) made.provenance.audit = {{0.5F, 0, 60e3F, 100, 100, 100, 0.75F, 0}};
        served_.add("KTLX", made);
    }
    using Kinds = std::vector<std::string>;
    ServedStorms served_;
};

TEST_F(ApiStorms, CellsAreGeoJson) {
    served_.add_half_hour("KTLX");
    const json all = geojson("/api/v1/cells");
    EXPECT_EQ(all["areas"].dump(), R"([{"area":"KTLX","from":"2024-11-22T12:00:00Z","grids":6,)"
                                   R"("time":"2024-11-22T12:25:00Z"}])");
    ASSERT_EQ(kinds(all), (Kinds{"cell", "track", "forecast"}));
    for (const json& feature : all["features"])
        EXPECT_EQ(feature["properties"]["area"], "KTLX");
    const json& point = all["features"][0]["geometry"];
    EXPECT_EQ(point["type"], "Point");
    EXPECT_NEAR(point["coordinates"][0], -97.25, 0.02) << "the longitude comes first";
    EXPECT_NEAR(point["coordinates"][1], 35.333, 0.02);
    EXPECT_EQ(all["features"][2]["geometry"]["coordinates"].size(), 5U);
    EXPECT_EQ(geojson("/api/v1/cells?area=KTLX"), all);
    const json earlier = geojson("/api/v1/cells?time=2024-11-22T12:00:00Z");
    EXPECT_EQ(kinds(earlier), (Kinds{"cell"}));
}

TEST_F(ApiStorms, CellsHaveMeshForTheFreezingLevelsOfTheConfiguration) {
    served_.add("KTLX", 0);
    const json usual = geojson("/api/v1/cells");
    EXPECT_EQ(usual["assumed_freezing_levels_m"], json({4200, 7300}));
    EXPECT_EQ(usual["freezing_levels_error_m"], 300);
    const json storm = usual["features"][0]["properties"];
    EXPECT_LT(storm["mesh_least_mm"], storm["mesh_mm"]);
    EXPECT_GT(storm["mesh_most_mm"], storm["mesh_mm"]);

    StormScans cold(served_.grids(), {2000, 5000});
    const auto lower = cold.track(storm_areas(*served_.grids(), {.area = "KTLX"})->front());
    ASSERT_TRUE(lower) << lower.error().message;
    EXPECT_EQ(lower->freezing, (retrieve::FreezingLevels{2000, 5000}));
    EXPECT_GT(lower->cells.front().cell.mesh_mm, storm["mesh_mm"].get<float>());
}

TEST_F(ApiStorms, CellsOfSeveralAreasNameTheirArea) {
    served_.add("KTLX", 0);
    served_.add("KFWS", 1, 20);
    const json all = geojson("/api/v1/cells");
    ASSERT_EQ(kinds(all), (Kinds{"cell", "cell"}));
    EXPECT_EQ(all["features"][0]["properties"]["area"], "KFWS");
    EXPECT_EQ(all["features"][1]["properties"]["area"], "KTLX");
}

TEST_F(ApiStorms, WithoutGridsThereAreNoFeatures) {
    EXPECT_TRUE(geojson("/api/v1/cells")["features"].empty());
    served_.add("KTLX", 0);
    const json later = geojson("/api/v1/cells?area=KTLX&time=2024-11-23T00:00:00Z");
    EXPECT_TRUE(later["features"].empty());
    EXPECT_EQ(later["areas"][0]["time"], nullptr);
}

TEST_F(ApiStorms, AnswersAreKeptUntilAGridComes) {
    served_.add("KTLX", 0);
    const Request request = request_for("/api/v1/cells", {});
    EXPECT_FALSE(served_.api().answer_soon(request)) << "the computation waits for its turn";
    const Answer answer = get("/api/v1/cells");
    EXPECT_EQ(header_of(answer, "Cache-Control"), "no-cache");
    const Fields known{{"If-None-Match", header_of(answer, "ETag")}};
    EXPECT_TRUE(served_.api().answer_soon(request));
    EXPECT_EQ(get("/api/v1/cells", known).status, 304U);
    served_.add("KTLX", 5);
    EXPECT_FALSE(served_.api().answer_soon(request));
    EXPECT_EQ(get("/api/v1/cells", known).status, 200U);
    EXPECT_EQ(served_.scans()->searched(), 2U);
}

TEST_F(ApiStorms, RefuseWhatMakesNoSense) {
    served_.add("KTLX", 0);
    for (const char* target : {"/api/v1/cells?area=KTLX&area=KTLX", "/api/v1/cells?colour=red",
                               "/api/v1/cells?time=soon", "/api/v1/cells?time=",
                               "/api/v1/rotation?time=1e999", "/api/v1/rotation?x=1"}) {
        EXPECT_EQ(get(target).status, 400U) << target;
    }
    for (const char* target :
         {"/api/v1/cells?area=KOKX", "/api/v1/cells?area=", "/api/v1/cells?area=..%2f",
          "/api/v1/rotation?area=KOKX", "/api/v1/cells/KTLX"}) {
        EXPECT_EQ(get(target).status, 404U) << target;
    }
    ApiDoor without{ApiSources{.grids = served_.grids(), .catalog = {}, .kept = nullptr}};
    EXPECT_EQ(asked(without, "/api/v1/cells").status, 404U);
}

TEST_F(ApiStorms, RotationHasPlaceLayerAndKnownError) {
    add_vortex(20, 10, true);
    const json all = geojson("/api/v1/rotation");
    ASSERT_EQ(kinds(all), (Kinds{"shear_maximum", "shear_maximum"}));
    const json& low = all["features"][0];
    EXPECT_EQ(low["properties"]["layer"], "low");
    EXPECT_NEAR(low["properties"]["azimuthal_shear_per_s"], 0.02, 2e-5);
    EXPECT_EQ(low["properties"]["gridding_rms_per_s"], 0.00075);
    EXPECT_EQ(low["properties"]["height_m"], 1000);
    EXPECT_NEAR(low["geometry"]["coordinates"][0], -97.278 + 10.5 / 90.9, 1e-3);
    EXPECT_EQ(all["features"][1]["properties"]["layer"], "mid");
    EXPECT_FALSE(all.contains("reason"));
}

// The tornado of 3 May 1999 is at 35.25 N 97.69 W in the lowest sweep (docs/velocity.md: a maximum
// is within 1.5 km of the tornado). Grids of 2 km, as here, have their maximum in the middle of a
// cell, up to 1.4 km from the maximum of the gates.
TEST(RotationOfMoore, IsTheStrongestInRealGridsOfTheIngestor) {
    STORMCELLAR_NEED_DATA();
    const PicturedStorm storm("KTLX19990503_235621.gz", {},
                              {level2::Moment::ref, level2::Moment::azsh});
    const auto scans = std::make_shared<StormScans>(storm.grids());
    const auto kept = std::make_shared<KeptAnswers>(std::uint64_t{1} << 20);
    ApiDoor door(ApiSources{.grids = storm.grids(),
                            .catalog = {},
                            .kept = kept,
                            .storms = std::make_shared<const StormAnswers>(scans, kept)});
    const json all = json::parse(body_of(asked(door, "/api/v1/rotation")));
    const json cells = json::parse(body_of(asked(door, "/api/v1/cells")));
    const grid::SiteFrame tornado(35.25, -97.69);
    const auto from_tornado_m = [&](const json& feature) {
        const json& at = feature["geometry"]["coordinates"];
        return tornado.to_polar({at[1], at[0]}).arc_m;
    };
    ASSERT_FALSE(all["features"].empty());
    const json& strongest = all["features"][0];
    EXPECT_EQ(strongest["properties"]["layer"], "low");
    EXPECT_EQ(strongest["properties"]["time"], PicturedStorm::time);
    EXPECT_GT(strongest["properties"]["azimuthal_shear_per_s"], 0.02);
    EXPECT_LT(from_tornado_m(strongest), 1500 + 1415) << strongest;
    // The cell of the tornado has the shear.
    const bool has_shear = std::ranges::any_of(cells["features"], [&](const json& feature) {
        return from_tornado_m(feature) < 15e3 &&
               feature["properties"].value("azimuthal_shear_per_s", 0.0) > 0.01;
    });
    EXPECT_TRUE(has_shear);
}

TEST_F(ApiStorms, RotationWithoutShearSaysWhy) {
    served_.add("KTLX", 0);
    for (const char* target : {"/api/v1/rotation", "/api/v1/rotation?area=KTLX"}) {
        const json all = geojson(target);
        EXPECT_TRUE(all["features"].empty());
        EXPECT_EQ(all["reason"], "there are no grids of AZSH");
    }
    add_vortex(3, 10, false);
    const json weak = geojson("/api/v1/rotation");
    EXPECT_TRUE(weak["features"].empty());
    EXPECT_FALSE(weak.contains("reason")) << "there are grids, but no strong shear";
}

}  // namespace
}  // namespace stormcellar::web
