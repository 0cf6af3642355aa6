// Compares what RainViewer's interface serves with the grid's cells, and tests its frames and
// refusals.
#include "web/doors/rainviewer/rainviewer.h"

#include <cmath>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "render/color/built_in_tables.h"
#include "tests/web/pictured_storm.h"
#include "tests/web/served_grids.h"

namespace stormcellar::web {
namespace {

class RainViewer : public MapDoorTest<RainViewerDoor> {
  protected:
    nlohmann::json maps(const std::string& prefix = "") {
        const Answer answer = get(prefix + "/public/weather-maps.json");
        EXPECT_EQ(answer.status, 200U) << body_of(answer);
        EXPECT_EQ(header_of(answer, "Content-Type"), "application/json");
        return nlohmann::json::parse(body_of(answer));
    }
    // Returns the tile below the newest frame's path.
    render::Image tile(const std::string& rest) {
        const std::string path = maps()["radar"]["past"].back()["path"];
        const Answer answer = get(path + rest);
        EXPECT_EQ(answer.status, 200U) << body_of(answer);
        EXPECT_EQ(header_of(answer, "Content-Type"), "image/png");
        return decoded_png(body_of(answer));
    }
};

TEST_F(RainViewer, ListsTheFrames) {
    const auto all = maps();
    EXPECT_EQ(all["version"], "2.0");
    EXPECT_GT(all["generated"].get<std::int64_t>(), 1'700'000'000);
    ASSERT_EQ(all["radar"]["past"].size(), 1U);
    EXPECT_EQ(all["radar"]["past"][0]["time"], 925775781) << "1999-05-03 23:56:21 UTC";
    EXPECT_EQ(all["radar"]["past"][0]["path"], "/v2/radar/925775781");
    EXPECT_TRUE(all["radar"]["nowcast"].empty());
    EXPECT_TRUE(all["satellite"]["infrared"].empty());
    const std::string host = all["host"];
    EXPECT_EQ(maps("/rainviewer/KTLX")["host"], host + "/rainviewer/KTLX");
    EXPECT_EQ(get("/rainviewer/KTLX/v2/radar/925775781/256/8/58/100/6/0_0.png").status, 200U);
    for (const char* path : {"/public/maps.json", "/api/maps.json"})
        EXPECT_EQ(body_of(get(path)), "[925775781]\n");
    EXPECT_EQ(get("/rainviewer/KXXX/public/weather-maps.json").status, 404U);
}

// The tile 8/58/100 is near the middle of the storm.
TEST_F(RainViewer, TilesShowTheTableOfTheirScheme) {
    const auto grid = storm_->grid(level2::Moment::ref);
    const auto gray = tile("/256/8/58/100/0/0_0.png");
    const auto classes = tile("/256/8/58/100/6/0_1.png");
    const render::ColorTable& nws = render::nws_reflectivity();
    ASSERT_EQ(gray.width, 256);
    int shown = 0, strong = 0, wrong = 0;
    for (std::size_t i = 0; i < gray.rgba.size(); i += 4) {
        if (gray.rgba[i + 3] == 0) {
            wrong += classes.rgba[i + 3] == 0 ? 0 : 1;
            continue;
        }
        ++shown;
        const int dbz = gray.rgba[i] - 32;
        strong += dbz >= 50 ? 1 : 0;
        const render::Rgba8 color =
            render::color_of(nws, static_cast<float>(dbz)).value_or(render::Rgba8{});
        wrong += classes.rgba[i] == color[0] && classes.rgba[i + 1] == color[1] &&
                         classes.rgba[i + 3] == color[3]
                     ? 0
                     : 1;
        EXPECT_EQ(gray.rgba[i], gray.rgba[i + 2]);
    }
    EXPECT_GT(shown, 5000);
    EXPECT_GT(strong, 100);
    EXPECT_EQ(wrong, 0)
        << "bounds of the classes are whole numbers, so rounding down keeps the class";
    EXPECT_EQ(tile("/512/8/58/100/2/1_1.png").width, 512);
    const Answer webp = get("/v2/radar/925775781/256/8/58/100/2/0_0.webp");
    EXPECT_EQ(header_of(webp, "Content-Type"), "image/webp");
    EXPECT_EQ(body_of(webp).substr(8, 4), "WEBP");
    EXPECT_NE(tile("/256/8/58/100/2/1_0.png").rgba, tile("/256/8/58/100/2/0_0.png").rgba);
    EXPECT_EQ(tile("/256/8/58/100/2/0_1.png").rgba, tile("/256/8/58/100/2/0_0.png").rgba);
}

TEST_F(RainViewer, APictureAroundAPlaceIsTheTileMoved) {
    // The center of the tile 8/58/100.
    const double world_m = 2 * render::mercator_edge_m / 256;
    const double latitude =
        render::mercator_latitude_deg(render::mercator_edge_m - 100.5 * world_m);
    const double longitude = 58.5 / 256 * 360 - 180;
    const auto around = tile(fmt::format("/256/8/{:.9f}/{:.9f}/0/0_0.png", latitude, longitude));
    const auto plain = tile("/256/8/58/100/0/0_0.png");
    int different = 0;
    for (std::size_t i = 0; i < plain.rgba.size(); i += 4)
        different += plain.rgba[i] == around.rgba[i] ? 0 : 1;
    EXPECT_LT(different, 256 * 256 / 100) << "the places differ by rounding";
}

TEST_F(RainViewer, CoverageIsBlackWhereNoBeamLooked) {
    const auto grid = storm_->grid(level2::Moment::ref);
    const grid::BrickView view = grid->file.view();
    const auto image = decoded_png(body_of(get("/v2/coverage/0/256/6/14/25/0/0_0.png")));
    ASSERT_EQ(image.width, 256);
    const grid::GridProjection projection(*view.spec);
    int black = 0, clear = 0, wrong = 0;
    for (int y = 0; y < 256; y += 5) {
        for (int x = 0; x < 256; x += 5) {
            const double side_m = 2 * render::mercator_edge_m / 64 / 256;
            const double north = render::mercator_edge_m - (25 * 256 + y + 0.5) * side_m;
            const grid::ColumnPoint at = projection.to_column(
                {render::mercator_latitude_deg(north), (14 * 256 + x + 0.5) / 16384 * 360 - 180});
            const int column = static_cast<int>(std::floor(at.x + 0.5));
            const int row = static_cast<int>(std::floor(at.y + 0.5));
            bool is_seen = false;
            if (column >= 0 && row >= 0 && column < view.spec->nx && row < view.spec->ny) {
                for (int z = 0; z < view.spec->nz(); ++z)
                    is_seen |= view.status(column, row, z) != grid::CellStatus::not_seen;
            }
            const render::Rgba8 color = image.at(x, y);
            const render::Rgba8 right = is_seen ? render::Rgba8{} : render::Rgba8{0, 0, 0, 255};
            (is_seen ? clear : black) += 1;
            wrong += color == right ? 0 : 1;
        }
    }
    EXPECT_GT(black, 50);
    EXPECT_GT(clear, 50);
    EXPECT_LE(wrong, (black + clear) / 50) << "a pixel of this zoom covers some cells";
    EXPECT_EQ(header_of(get("/v2/coverage/0/256/6/14/25/0/0_0.png"), "Cache-Control"), "no-cache")
        << "a newer grid may have seen more";
    const auto far = decoded_png(body_of(get("/v2/coverage/0/256/6/0/0/0/0_0.png")));
    EXPECT_EQ(far.at(100, 100), (render::Rgba8{0, 0, 0, 255}));
}

TEST_F(RainViewer, RefusesWhatIsNotThere) {
    for (const char* path :
         {"/public/nothing.json", "/v2/radar", "/v2/radar/925775781/256/8/58/100/9/0_0.png",
          "/v2/radar/925775781/256/8/58/100/2/2_0.png",
          "/v2/radar/925775781/256/8/58/100/2/0_0.gif",
          "/v2/other/925775781/256/8/58/100/2/0_0.png", "/v2/radar/1/256/8/58/100/2/0_0.png",
          "/v2/radar/925775781/300/8/58/100/2/0_0.png", "/v2/radar/x/256/8/58/100/2/0_0.png",
          "/v2/radar/-1/256/8/58/100/2/0_0.png", "/v2/radar/925775781/256/8/258/100/2/0_0.png",
          "/v2/radar/99999999999999/256/8/58/100/2/0_0.png", "/rainviewer/KTLX",
          "/v2/radar/925775781/256/8/89.0/10.0/2/0_0.png",
          "/v2/radar/925775781/256/8/nan./10.0/2/0_0.png",
          "/rainviewer/KXXX/v2/coverage/0/256/6/14/25/0/0_0.png"}) {
        EXPECT_EQ(get(path).status, 404U) << path;
    }
}

TEST_F(RainViewer, AnUnchangedTileIsNotSentAgain) {
    const std::string path = "/v2/radar/925775781/256/8/58/100/2/1_1.png";
    const std::string etag = header_of(get(path), "ETag");
    EXPECT_EQ(get(path, {{"If-None-Match", etag}}).status, 304U);
    EXPECT_NE(header_of(get("/v2/radar/925775781/256/8/58/100/0/1_1.png"), "ETag"), etag);
}

TEST(RainViewerFrames, AreTheLastOfEachTenMinutesOfTwoHours) {
    const UtcTime noon = testing::noon;
    std::vector<UtcTime> times;
    for (int minute = -180; minute <= 4; minute += 4)
        times.push_back(noon + std::chrono::minutes{minute});
    const auto frames = frame_times(times);
    ASSERT_EQ(frames.size(), 13U);
    EXPECT_EQ(frames.back(), noon + std::chrono::minutes{4});
    EXPECT_EQ(frames[frames.size() - 2], noon - std::chrono::minutes{4});
    EXPECT_GE(frames.front(), frames.back() - std::chrono::hours{2});
    EXPECT_TRUE(frame_times({}).empty());
}

// A mosaic is what a client without a domain should get.
TEST(RainViewerFrames, AreThoseOfTheMosaic) {
    ServedGrids served;
    RainViewerDoor door(
        std::make_shared<MapPictures>(MapPicturesOptions{.grids = served.shared_grids()}));
    const auto newest = [&] {
        const auto maps = nlohmann::json::parse(body_of(asked(door, "/public/weather-maps.json")));
        return maps["radar"]["past"].back()["time"].get<std::int64_t>();
    };
    const auto noon = std::chrono::floor<std::chrono::seconds>(testing::noon);
    const std::int64_t noon_s = noon.time_since_epoch().count();
    EXPECT_EQ(newest(), noon_s + 300) << "of the station KBGM";
    ASSERT_TRUE(
        testing::commit_sized(served.store(), "northeast", testing::noon + std::chrono::hours{1}));
    served.grids().refresh();
    EXPECT_EQ(newest(), noon_s + 3600);
}

}  // namespace
}  // namespace stormcellar::web
