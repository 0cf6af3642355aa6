// Tests that rings and sites are at their places on the map, whatever its projection.
#include "render/map/map_lines.h"

#include <cmath>

#include <GeographicLib/Geodesic.hpp>
#include <gtest/gtest.h>

#include "base/floating_point.h"
#include "render/image/shades.h"
#include "render/map/draw_marks.h"
#include "stormcellar/grid/projection.h"
#include "tests/render/synthetic_storm.h"

namespace stormcellar::render {
namespace {

using grid::Projection;

constexpr int side = 900;

grid::GridSpec map_of(Projection projection, double latitude_deg, double longitude_deg) {
    grid::GridSpec spec = small_spec(400, 2);
    spec.projection = projection;
    spec.center_latitude_deg = latitude_deg;
    spec.center_longitude_deg = longitude_deg;
    if (projection == Projection::latitude_longitude) {
        spec.spacing_m = 0;
        spec.spacing_deg = 0.01;
    }
    if (projection == Projection::lambert_conformal) {
        spec.parallels_deg = {latitude_deg - 5, latitude_deg + 5};
    }
    return spec;
}

bool is_ring(Rgba8 pixel) {
    for (std::size_t c = 0; c < 3; ++c) {
        const double alpha = shades::dark.ring[3] / 255.0;
        const double over_white = 255 * (1 - alpha) + shades::dark.ring[c] * alpha;
        if (std::abs(pixel[c] - over_white) > 1.01) return false;
    }
    return true;
}

// Returns the distance along WGS84 from the site to the place of a pixel.
double arc_m(const grid::GridSpec& spec, const ViewGeometry& view, const grid::SitePosition& site,
             Pixel pixel) {
    const auto ground = view.ground(pixel);
    const grid::ColumnPoint column = {ground->x_m / spec.cell_width_m() + 0.5 * (spec.nx - 1),
                                      ground->y_m / spec.cell_height_m() + 0.5 * (spec.ny - 1)};
    const grid::GeoPoint place = grid::GridProjection(spec).to_geo(column);
    double arc = 0;
    GeographicLib::Geodesic::WGS84().Inverse(site.latitude_deg, site.longitude_deg,
                                             place.latitude_deg, place.longitude_deg, arc);
    return arc;
}

// Expects that every pixel of a ring is at the distance of one of the rings, within two pixels.
void expect_rings(const grid::GridSpec& spec, const grid::SitePosition& site) {
    const auto fonts = Fonts::load();
    ASSERT_TRUE(fonts);
    const ViewGeometry view(spec, Camera{180, 0, 1}, 1, side, side);
    const std::vector<grid::SitePosition> sites = {site};
    MapLines lines;
    lines.geometry = &view;
    lines.spec = &spec;
    lines.sites = &sites;
    lines.scale = 3;  // lines wide enough to cover whole pixels
    Canvas canvas(side, side, {255, 255, 255, 255});
    draw_rings(canvas, lines);
    const Image image = canvas.image();
    int pixels = 0;
    int off = 0;
    double farthest_m = 0;
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            if (!is_ring(image.at(x, y))) continue;
            const double arc = arc_m(spec, view, site, {x + 0.5, y + 0.5});
            const double ring_m = std::round(arc / lines.ring_spacing_m) * lines.ring_spacing_m;
            ++pixels;
            off += std::abs(arc - ring_m) > 2 * view.metres_per_pixel() ? 1 : 0;
            farthest_m = std::max(farthest_m, ring_m);
        }
    }
    EXPECT_GT(pixels, 4000);
    EXPECT_EQ(off, 0);
    EXPECT_GE(farthest_m, 200e3);
}

TEST(MapLines, RingsAreAtTheirDistanceOnEveryProjection) {
    const MaskedTraps masked;  // GeographicLib overflows in intermediate results
    for (const Projection projection :
         {Projection::azimuthal_equidistant, Projection::latitude_longitude,
          Projection::lambert_conformal}) {
        for (const auto& [latitude_deg, longitude_deg] :
             {std::pair{35.0, -97.0}, std::pair{64.5, 179.5}, std::pair{-13.0, -179.9}}) {
            SCOPED_TRACE(fmt::format("{} {}", grid::projection_name(projection), latitude_deg));
            const grid::GridSpec spec = map_of(projection, latitude_deg, longitude_deg);
            ASSERT_TRUE(validate(spec));
            expect_rings(spec, {"KTLX", latitude_deg + 0.4, longitude_deg - 0.3, 300});
        }
    }
}

TEST(MapLines, ASiteIsMarkedInItsColumn) {
    const auto fonts = Fonts::load();
    ASSERT_TRUE(fonts);
    for (const Projection projection :
         {Projection::azimuthal_equidistant, Projection::latitude_longitude,
          Projection::lambert_conformal}) {
        const grid::GridSpec spec = map_of(projection, 52, 179.8);
        const grid::GeoPoint place = grid::column_position(spec, 300, 120);
        const ViewGeometry view(spec, Camera{180, 0, 1}, 1, side, side);
        const std::vector<grid::SitePosition> sites = {
            {"PAHG", place.latitude_deg, place.longitude_deg, 100}};
        MapLines lines;
        lines.geometry = &view;
        lines.spec = &spec;
        lines.sites = &sites;
        Canvas canvas(side, side, {255, 255, 255, 255});
        draw_marks(canvas, *fonts, lines, plan_marks(*fonts, lines));
        const Pixel at = view.project(spec.x_m(300), spec.y_m(120), 0);
        const Rgba8 pixel = canvas.image().at(static_cast<int>(at.x), static_cast<int>(at.y));
        EXPECT_EQ(pixel, shades::dark.text) << grid::projection_name(projection);
    }
}

TEST(RangeRings, AreFewWhateverTheSizeOfTheGrid) {
    grid::GridSpec spec = grid::default_spec(35, -97);
    const auto usual = [&](int cells, double spacing_m) {
        spec.nx = spec.ny = cells;
        spec.spacing_m = spacing_m;
        Scene scene;
        scene.range_ring_spacing_m = Scene::usual_rings;
        return drawn_ring_spacing(spec, scene);
    };
    EXPECT_EQ(usual(460, 1000), 50e3);
    EXPECT_EQ(usual(920, 1000), 100e3) << "the whole range of a sweep";
    EXPECT_EQ(usual(1000, 4000), 400e3);
    EXPECT_EQ(usual(160, 250), 10e3);
    Scene asked;
    asked.range_ring_spacing_m = 5e3;
    EXPECT_EQ(drawn_ring_spacing(spec, asked), 5e3) << "the scene asks for this spacing";
}

}  // namespace
}  // namespace stormcellar::render
