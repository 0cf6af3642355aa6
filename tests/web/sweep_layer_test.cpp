// Compares tiles of sweeps with the gates of the raw volume, and tests what the layers take.
#include "web/data/pictures/sweep_layer.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "grid/place/source_volume.h"
#include "render/options/sweep_source.h"
#include "stormcellar/grid/gridder.h"
#include "stormcellar/grid/site_frame.h"
#include "stormcellar/level2/decode.h"
#include "stormcellar/render/product.h"
#include "tests/web/asked.h"
#include "tests/web/pictured_storm.h"
#include "web/doors/pictures/tiles.h"

namespace stormcellar::web {
namespace {

class SweepLayers : public PictureTest {
  protected:
    void SetUp() override {
        PictureTest::SetUp();
        if (IsSkipped()) return;
        door_ = std::make_unique<TilesDoor>(std::make_shared<MapPictures>(MapPicturesOptions{
            .grids = storm_->grids(),
            .sweeps = std::make_shared<SweepPictures>(
                std::make_shared<ServedCatalog>(storm_->catalog()), FramePicturesOptions{})}));
    }
    Answer get(const std::string& path) { return asked(*door_, "/tiles/KTLX/" + path); }
    render::Image tile(const std::string& path) {
        const Answer answer = get(path);
        EXPECT_EQ(answer.status, 200U) << body_of(answer);
        return decoded_png(body_of(answer));
    }
    // Compares each fifth pixel of a tile of 256 pixels with the gate at its center.
    void expect_gates(const render::Image& image, const SweepLayer& layer, int zoom, int column,
                      int row) {
        const auto volume =
            std::make_shared<const level2::Volume>(level2::decode_file(storm_->file())->volume);
        const grid::SitePosition site =
            storm_->grid(level2::Moment::ref)->file.description().sites.front();
        const auto sweep = grid::SweepLookup::find(volume, site, layer.map.layer.moment,
                                                   grid::beam_width_of("KTLX") / 2,
                                                   render::sweep_wish_of(layer.map.scene));
        ASSERT_TRUE(sweep) << sweep.error().message;
        const grid::SiteFrame frame(site.latitude_deg, site.longitude_deg);
        int wrong = 0, shown = 0, count = 0;
        for (int y = 0; y < 256; y += 5) {
            for (int x = 0; x < 256; x += 5) {
                const double world = 256 * std::exp2(zoom);
                const double north = std::numbers::pi * (1 - 2 * (row * 256 + y + 0.5) / world);
                const grid::GeoPoint place{std::atan(std::sinh(north)) * 180 / std::numbers::pi,
                                           (column * 256 + x + 0.5) / world * 360 - 180};
                const grid::GateValue gate = sweep->at(frame.to_polar(place));
                render::Rgba8 color{};
                if (gate.status == grid::CellStatus::value)
                    color = render::color_of(render::colors_of(layer.map.scene), gate.value)
                                .value_or(color);
                if (gate.status == grid::CellStatus::range_folded)
                    color = render::colors_of(layer.map.scene).range_folded;
                if (gate.status == grid::CellStatus::not_seen) color = {96, 100, 108, 72};
                ++count;
                shown += color[3] == 255 ? 1 : 0;
                wrong += image.at(x, y) == color ? 0 : 1;
            }
        }
        EXPECT_GT(shown, count / 10);
        EXPECT_LE(wrong, count / 50) << "pixels at the edge of a gate may show its neighbor";
    }
    std::unique_ptr<TilesDoor> door_;
};

TEST_F(SweepLayers, EachPixelShowsTheGateAtItsPlace) {
    const auto reflectivity = sweep_layer("ppi.REF", {});
    ASSERT_TRUE(reflectivity);
    expect_gates(tile("ppi.REF/latest/10/235/404.png"), *reflectivity, 10, 235, 404);
    const auto velocity = sweep_layer("ppi.VEL", {{"elevation", "1.5"}, {"colors", "nws"}});
    ASSERT_TRUE(velocity) << velocity.error().message;
    expect_gates(tile("ppi.VEL/latest/11/470/808.png?elevation=1.5&colors=nws"), *velocity, 11, 470,
                 808);
}

TEST_F(SweepLayers, FromAfarAPixelShowsTheStrongestGate) {
    const render::Image image = tile("ppi.REF/latest/4/3/6.png");
    const auto layer = sweep_layer("ppi", {});
    const render::Rgba8 strongest = *render::color_of(render::colors_of(layer->map.scene), 65);
    int strong = 0, shown = 0;
    for (int y = 0; y < 256; ++y) {
        for (int x = 0; x < 256; ++x) {
            const render::Rgba8 color = image.at(x, y);
            strong += color[3] == 255 && color[0] >= strongest[0] - 40 ? 1 : 0;
            shown += color[3] == 255 ? 1 : 0;
        }
    }
    EXPECT_GT(strong, 0);
    EXPECT_GT(shown, 100);
}

// The raw volume has moments that no grid of the cache has.
TEST_F(SweepLayers, AnyMomentOfTheRawVolumeCanBeShown) {
    const render::Image width = tile("ppi.SW/latest/8/58/100.png");
    const render::Image dealiased = tile("ppi.VELD/latest/8/58/100.png");
    EXPECT_NE(width.rgba, dealiased.rgba);
    EXPECT_NE(dealiased.rgba, tile("ppi.VEL/latest/8/58/100.png").rgba);
    EXPECT_EQ(get("ppi.ZDR/latest/8/58/100.png").status, 404U) << "the radar had no ZDR in 1999";
}

TEST_F(SweepLayers, TileJsonHasTheReachOfTheSweep) {
    const auto json = nlohmann::json::parse(
        body_of(get(std::string("ppi.REF/") + PicturedStorm::time + "/tilejson.json?sweep=0")));
    EXPECT_LT(json["bounds"][0], -101.5) << "460 km";
    EXPECT_GT(json["bounds"][2], -93);
    EXPECT_TRUE(json["tiles"][0].get<std::string>().ends_with(
        std::string("/tiles/KTLX/ppi.REF/") + PicturedStorm::time + "/{z}/{x}/{y}.png?sweep=0"));
    const auto index = nlohmann::json::parse(body_of(asked(*door_, "/tiles")));
    EXPECT_NE(index["options_of_ppi"].get<std::string>().find("elevation"), std::string::npos);
    EXPECT_EQ(index["domains"][0]["layers"].back()["layer"], "ppi.VEL");
}

TEST_F(SweepLayers, RefuseWhatMakesNoSense) {
    EXPECT_EQ(get("ppi.XYZ/latest/8/58/100.png").status, 404U);
    EXPECT_EQ(get("ppi.REF/latest/8/58/300.png").status, 404U);
    EXPECT_EQ(get("ppi.REF/1999-05-03T00:00:00Z/8/58/100.png").status, 404U);
    EXPECT_EQ(get("ppi.REF/noon/8/58/100.png").status, 400U);
    EXPECT_EQ(get("ppi.REF/latest/8/58/100.png?elevation=x").status, 400U);
    EXPECT_EQ(get("ppi.REF/latest/8/58/100.png?smooth=cubic").status, 400U);
    EXPECT_EQ(get("ppi.REF/latest/8/58/100.png?sweep=99").status, 404U);
    EXPECT_EQ(asked(*door_, "/tiles/KXXX/ppi.REF/latest/8/58/100.png").status, 404U);
    TilesDoor without(std::make_shared<MapPictures>(MapPicturesOptions{.grids = storm_->grids()}));
    EXPECT_EQ(asked(without, "/tiles/KTLX/ppi.REF/latest/8/58/100.png").status, 404U);
}

}  // namespace
}  // namespace stormcellar::web
