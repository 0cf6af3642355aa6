#include "render/map/map_layer.h"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/image/shades.h"
#include "render/map/map_ground.h"
#include "render/products/ground.h"
#include "tests/render/small_map.h"
#include "tests/render/synthetic_storm.h"

namespace stormcellar::render {
namespace {

using grid::GeoPoint;
using grid::Projection;

grid::GridSpec spec_of(Projection projection, double latitude_deg, double longitude_deg, int side,
                       double spacing_m) {
    return projected_spec(projection, latitude_deg, longitude_deg, side, side, spacing_m);
}

// Returns the view of a 2D product, from straight above.
ViewGeometry flat(const grid::GridSpec& spec, int width, int height, double zoom = 1) {
    return {spec, Camera{180, 0, zoom}, 1, width, height};
}

double distance_px(Point p, Point a, Point b) {
    const double dx = b.x - a.x;
    const double dy = b.y - a.y;
    const double length2 = dx * dx + dy * dy;
    const double share =
        length2 > 0 ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / length2, 0.0, 1.0) : 0;
    return std::hypot(p.x - a.x - share * dx, p.y - a.y - share * dy);
}

double distance_px(Point p, const MapLayer& layer, MapKind kind) {
    double nearest = 1e9;
    for (const MapStroke& stroke : layer.strokes) {
        if (stroke.kind != kind) continue;
        for (std::size_t i = 1; i < stroke.points.size(); ++i)
            nearest = std::min(nearest, distance_px(p, stroke.points[i - 1], stroke.points[i]));
    }
    return nearest;
}

Point exact_pixel(const GroundMap& ground, const ViewGeometry& view, GeoPoint place) {
    const GroundPoint at = ground.ground(place);
    const Pixel pixel = view.project(at.x_m, at.y_m, view.ground_m());
    return {pixel.x, pixel.y};
}

// Compares a parallel with two vertices, 40 degrees apart, with the projections of all of its
// points.
TEST(MapLayer, LongSegmentsFollowTheirCurve) {
    const auto bytes = SmallMap{}.set(MapKind::country, 0, 0, {{{49, -120}, {49, -80}}}).bytes();
    const auto map = BaseMap::read(bytes).value();
    for (const Projection projection :
         {Projection::azimuthal_equidistant, Projection::lambert_conformal,
          Projection::latitude_longitude}) {
        const grid::GridSpec spec = spec_of(projection, 45, -100, 400, 10e3);
        for (const ViewGeometry& view : {flat(spec, 800, 800), flat(spec, 4000, 4000),
                                         ViewGeometry(spec, Camera{150, 60, 1}, 5, 1000, 700)}) {
            const MapLayer layer = prepare_map(map, spec, view, 1).value();
            ASSERT_FALSE(layer.strokes.empty());
            const GroundMap ground(spec);
            double worst = 0;
            for (int i = 0; i <= 3000; ++i) {
                const double longitude = -115 + 0.01 * i;
                const Point p = exact_pixel(ground, view, {49, longitude});
                worst = std::max(worst, distance_px(p, layer, MapKind::country));
            }
            EXPECT_LT(worst, 0.2 + 0.3) << static_cast<int>(projection);
            // The line has no more points than the curve requires.
            EXPECT_LT(layer.strokes.front().points.size(), 400U);
        }
    }
}

TEST(MapLayer, LinesFillThePictureAndEndWithIt) {
    const auto map = BaseMap::built_in().value();
    const grid::GridSpec spec = spec_of(Projection::azimuthal_equidistant, 40.9, -76, 230, 2000);
    for (const double zoom : {0.5, 1.0, 8.0}) {
        const ViewGeometry view = flat(spec, 600, 500, zoom);
        const MapLayer layer = prepare_map(map, spec, view, 1).value();
        ASSERT_GT(layer.strokes.size(), 10U);
        int at_edge = 0;
        for (const MapStroke& stroke : layer.strokes) {
            ASSERT_GE(stroke.points.size(), 2U);
            for (const Point& p : stroke.points) {
                EXPECT_GE(p.x, -1e-6);
                EXPECT_LE(p.x, 600 + 1e-6);
                EXPECT_GE(p.y, -1e-6);
                EXPECT_LE(p.y, 500 + 1e-6);
                at_edge += p.x < 1e-6 || p.x > 600 - 1e-6 ? 1 : 0;
            }
        }
        EXPECT_GT(at_edge, 3) << "lines go on to the edge";
    }
}

// In a slanted view, the map ends at a limited distance outside the grid.
TEST(MapLayer, LinesAtASlantEndAroundTheGrid) {
    const auto map = BaseMap::built_in().value();
    const grid::GridSpec spec = spec_of(Projection::azimuthal_equidistant, 40.9, -76, 230, 2000);
    const ViewGeometry view(spec, Camera{180, 70, 0.3}, 5, 600, 500);
    const MapLayer layer = prepare_map(map, spec, view, 1).value();
    double farthest_m = 0;
    for (const MapStroke& stroke : layer.strokes) {
        for (const Point& p : stroke.points)
            farthest_m = std::max(farthest_m, std::abs(view.ground({p.x, p.y})->x_m));
    }
    EXPECT_GT(farthest_m, view.half_x_m() * 1.5);
    EXPECT_LT(farthest_m, view.half_x_m() + reach_beyond_m(view) + 1);
}

// Simplification is not visible: points of the finest map are on the drawn lines.
TEST(MapLayer, CoarseLinesLieOnTheFinest) {
    const auto map = BaseMap::built_in().value();
    for (const double spacing_m : {2e3, 10e3, 40e3}) {
        const grid::GridSpec spec = spec_of(Projection::lambert_conformal, 38, -90, 100, spacing_m);
        const ViewGeometry view = flat(spec, 500, 500);
        const MapLayer layer = prepare_map(map, spec, view, 1).value();
        const GroundMap ground(spec);
        double worst = 0;
        for (const MapSet& set : map.sets()) {
            if (set.kind != MapKind::state || set.detail != 0) continue;
            for (const MapLine& line : set.lines) {
                const auto places = map.points_of(line).value();
                for (const GeoPoint& place : places) {
                    if (std::abs(place.longitude_deg + 90) > 25) continue;
                    const Point p = exact_pixel(ground, view, place);
                    if (p.x < 12 || p.y < 12 || p.x > 488 || p.y > 488) continue;
                    worst = std::max(worst, distance_px(p, layer, MapKind::state));
                }
            }
        }
        EXPECT_LT(worst, 1.2) << spacing_m;
    }
}

TEST(MapLayer, DenseLinesAreThereWhereTheyCanBeRead) {
    const auto map = BaseMap::built_in().value();
    using enum MapKind;
    const auto dense_kinds = [&](double spacing_m, double scale) {
        const grid::GridSpec spec =
            spec_of(Projection::azimuthal_equidistant, 35.3, -97.3, 460, spacing_m);
        const MapLayer layer = prepare_map(map, spec, flat(spec, 672, 462), scale).value();
        std::set<MapKind> found;
        for (const MapStroke& stroke : layer.strokes)
            if (stroke.kind == county || stroke.kind == highway || stroke.kind == interstate)
                found.insert(stroke.kind);
        return found;
    };
    EXPECT_EQ(dense_kinds(500, 1), (std::set{county, highway, interstate}));
    EXPECT_EQ(dense_kinds(1000, 1), (std::set{county, interstate}));
    EXPECT_EQ(dense_kinds(1000, 2), std::set{interstate}) << "lines are twice as wide";
    EXPECT_EQ(dense_kinds(4000, 1), std::set<MapKind>{});
}

// Draws the Aleutians. Lines east and west of 180 degrees are on both sides of the middle.
TEST(MapLayer, GoesOnAcrossTheAntimeridian) {
    const auto map = BaseMap::built_in().value();
    const grid::GridSpec spec = spec_of(Projection::azimuthal_equidistant, 52, 179.9, 200, 5000);
    const ViewGeometry view = flat(spec, 800, 800);
    const MapLayer layer = prepare_map(map, spec, view, 1).value();
    int west = 0;
    int east = 0;
    for (const MapStroke& stroke : layer.strokes) {
        for (std::size_t i = 0; i < stroke.points.size(); ++i) {
            (stroke.points[i].x < 400 ? west : east) += 1;
            if (i == 0) continue;
            const double step = std::hypot(stroke.points[i].x - stroke.points[i - 1].x,
                                           stroke.points[i].y - stroke.points[i - 1].y);
            EXPECT_LT(step, 60) << "no line leaps across the picture";
        }
    }
    EXPECT_GT(west, 50);
    EXPECT_GT(east, 50);
}

TEST(MapLayer, GridsAnywhereOnEarthHaveAMap) {
    const auto map = BaseMap::built_in().value();
    for (const GeoPoint center : {GeoPoint{90, 0}, GeoPoint{-90, 10}, GeoPoint{0, 0},
                                  GeoPoint{13.5, 144.8}, GeoPoint{71, -156}}) {
        const grid::GridSpec spec = spec_of(Projection::azimuthal_equidistant, center.latitude_deg,
                                            center.longitude_deg, 100, 5000);
        EXPECT_TRUE(prepare_map(map, spec, flat(spec, 300, 300), 1)) << center.latitude_deg;
        const ViewGeometry low(spec, Camera{20, 90, 3}, 5, 300, 300);
        EXPECT_TRUE(prepare_map(map, spec, low, 1));
    }
}

TEST(MapLayer, CitiesStandWhereTheyAreTheLargestFirst) {
    const auto bytes = SmallMap{}
                           .city("Large", 900, {35.0, -97.0})
                           .city("Far", 800, {45.0, -97.0})
                           .city("Small", 7, {36.0, -98.0})
                           .bytes();
    const auto map = BaseMap::read(bytes).value();
    const grid::GridSpec spec = spec_of(Projection::azimuthal_equidistant, 35.3, -97.3, 460, 1000);
    const ViewGeometry view = flat(spec, 600, 600);
    const MapLayer layer = prepare_map(map, spec, view, 1).value();
    ASSERT_EQ(layer.cities.size(), 2U);
    EXPECT_EQ(layer.cities[0].name, "Large");
    EXPECT_EQ(layer.cities[1].name, "Small");
    const Point p = exact_pixel(GroundMap(spec), view, {36.0, -98.0});
    EXPECT_NEAR(layer.cities[1].at.x, p.x, 1e-9);
    EXPECT_NEAR(layer.cities[1].at.y, p.y, 1e-9);
}

TEST(MapLayer, DrawsItsLinesAndNothingElse) {
    const auto bytes = SmallMap{}.set(MapKind::state, 0, 0, {{{40, -101}, {40, -99}}}).bytes();
    const auto map = BaseMap::read(bytes).value();
    const grid::GridSpec spec = spec_of(Projection::azimuthal_equidistant, 40, -100, 100, 1000);
    const ViewGeometry view = flat(spec, 200, 200);
    const MapLayer layer = prepare_map(map, spec, view, 1).value();
    Canvas canvas(220, 220, shades::dark.page);
    draw_map(canvas, layer, shades::dark, 1, {10, 20});
    const Image image = canvas.image();
    const Point middle = exact_pixel(GroundMap(spec), view, {40, -100});
    EXPECT_NE(image.at(static_cast<int>(middle.x) + 10, static_cast<int>(middle.y + 20)),
              shades::dark.page);
    int drawn = 0;
    for (int y = 0; y < 220; ++y) {
        for (int x = 0; x < 220; ++x) {
            if (image.at(x, y) == shades::dark.page) continue;
            ++drawn;
            EXPECT_LT(std::abs(y - middle.y - 20), 4) << x;
        }
    }
    EXPECT_GT(drawn, 150);
}

}  // namespace
}  // namespace stormcellar::render
