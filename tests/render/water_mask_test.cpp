#include "render/products/water_mask.h"

#include <gtest/gtest.h>

#include "render/image/area_mask.h"
#include "render/map/map_ground.h"
#include "render/map/map_layer.h"
#include "tests/render/small_map.h"
#include "tests/render/synthetic_storm.h"

namespace stormcellar::render {
namespace {

TEST(AreaMask, RingsThatRunTheOtherWayAreHoles) {
    AreaMask mask(10, 10);
    mask.add({{0, 0}, {0, 10}, {10, 10}, {10, 0}});
    mask.add({{2, 2}, {8, 2}, {8, 8}, {2, 8}});
    mask.put(true);
    auto cells = mask.cells();
    EXPECT_EQ(cells[0], 255);
    EXPECT_EQ(cells[55], 0);
    mask.add({{0, 0}, {0, 1}, {0.5, 1}, {0.5, 0}});
    mask.put(false);
    cells = mask.cells();
    EXPECT_NEAR(cells[0], 128, 2) << "half of the cell is water";
    EXPECT_EQ(cells[1], 255);
}

TEST(WaterMask, IsStraightBetweenTheCentersOfItsCells) {
    const WaterMask mask{.west_m = 0,
                         .north_m = 20,
                         .metres_per_cell = 10,
                         .width = 2,
                         .height = 2,
                         .water = {0, 255, 0, 255}};
    EXPECT_EQ(mask.water_at({5, 15}), 0);
    EXPECT_EQ(mask.water_at({15, 5}), 1);
    EXPECT_NEAR(mask.water_at({10, 10}), 0.5, 1e-12);
    EXPECT_EQ(mask.water_at({-1e9, 0}), 0);
    EXPECT_EQ(mask.water_at({1e9, 0}), 1);
    EXPECT_EQ(WaterMask{}.water_at({0, 0}), 0);
}

// The map has four rectangles of land that meet at 40 N 100 W, like tiles of the built-in map, and
// a lake in one rectangle.
TEST(WaterMask, OfAMapHasNoSeamsBetweenTiles) {
    using Ring = std::vector<grid::GeoPoint>;
    const auto quarter = [](double south, double west, double north, double east) {
        return Ring{{south, west}, {south, east}, {north, east}, {north, west}, {south, west}};
    };
    const auto bytes = SmallMap{}
                           .set(MapKind::coast, 0, 0,
                                {quarter(39, -101, 40, -100), quarter(39, -100, 40, -99.0),
                                 quarter(40, -101, 41.5, -100), quarter(40, -100, 41.5, -99.0)})
                           .set(MapKind::lake, 0, 0, {quarter(40.5, -99.5, 40.7, -99.3)})
                           .bytes();
    const auto map = BaseMap::read(bytes).value();
    grid::GridSpec spec = small_spec(400, 2);
    spec.center_latitude_deg = 40;
    spec.center_longitude_deg = -100;
    for (const Camera& camera : {Camera{180, 0, 1}, Camera{150, 50, 1}}) {
        const ViewGeometry view(spec, camera, 1, 600, 600);
        const MapLayer layer = prepare_map(map, spec, view, 1).value();
        const GroundMap ground(spec);
        const auto water = [&](double latitude, double longitude) {
            return layer.water.water_at(ground.ground({latitude, longitude}));
        };
        for (double off = -0.9; off < 0.9; off += 0.01) {
            EXPECT_LT(water(40, -100 + off), 0.01) << off;
            EXPECT_LT(water(40 + off, -100), 0.01) << off;
            EXPECT_LT(water(40 - 0.5 * off, -100 + off), 0.01) << off;
        }
        EXPECT_EQ(water(38.8, -100), 1);
        EXPECT_EQ(water(40, -101.2), 1);
        EXPECT_EQ(water(40.6, -99.4), 1) << "the place is in the lake";
        EXPECT_LT(water(40.6, -99.6), 0.01);
        // The coast is drawn around the land, but not along the edges of the tiles inside it.
        for (const MapStroke& stroke : layer.strokes) {
            if (stroke.kind != MapKind::coast) continue;
            for (const Point& p : stroke.points) {
                const auto place = ground.place(*view.ground({p.x, p.y}));
                const double inside =
                    std::min({place.latitude_deg - 39, 41.5 - place.latitude_deg,
                              place.longitude_deg + 101, -99.0 - place.longitude_deg});
                EXPECT_NEAR(inside, 0, 0.01);
            }
        }
    }
}

struct KnownPlace {
    double latitude_deg, longitude_deg;
    bool water;
    const char* name;
};
constexpr KnownPlace known_places[] = {
    {35.33, -97.28, false, "Oklahoma City"},
    {40.78, -73.97, false, "Central Park"},
    {40.0, -72.0, true, "the Atlantic south of Long Island"},
    {41.10, -72.90, true, "Long Island Sound"},
    {40.85, -73.0, false, "the middle of Long Island"},
    {28.0, -90.0, true, "the Gulf of Mexico"},
    {43.5, -87.0, true, "Lake Michigan"},
    {47.5, -87.5, true, "Lake Superior"},
    {48.0, -88.9, false, "Isle Royale"},
    {42.2, -81.2, true, "Lake Erie"},
    {43.6, -77.8, true, "Lake Ontario"},
    {45.76, -82.20, false, "Manitoulin Island"},
    {41.87, -87.65, false, "Chicago"},
    {43.70, -79.40, false, "Toronto"},
    {42.35, -83.07, false, "Detroit"},
    {26.95, -80.80, true, "Lake Okeechobee"},
    {41.2, -112.6, true, "Great Salt Lake"},
    {37.7, -122.3, true, "San Francisco Bay"},
    {38.2, -76.3, true, "Chesapeake Bay"},
    {47.75, -122.42, true, "Puget Sound"},
    {19.6, -155.5, false, "Hawaii"},
    {18.2, -66.5, false, "Puerto Rico"},
    {13.45, 144.77, false, "Guam"},
    {64.8, -147.7, false, "Fairbanks"},
    {26.5, 127.9, false, "Okinawa"},
    {37.0, 127.2, false, "Korea"},
    {40.0, -100.0, false, "the plains, where four tiles meet"},
    {20.0, -88.0, false, "Yucatan"},
};

TEST(WaterMask, OfTheBuiltInMapKnowsLandAndWater) {
    const auto map = BaseMap::built_in().value();
    for (const KnownPlace& known : known_places) {
        for (const double spacing_m : {300.0, 1000.0, 5000.0}) {
            grid::GridSpec spec = small_spec(200, 2);
            spec.spacing_m = spacing_m;
            spec.center_latitude_deg = known.latitude_deg;
            spec.center_longitude_deg = known.longitude_deg;
            const ViewGeometry view(spec, Camera{180, 0, 1}, 1, 400, 400);
            const MapLayer layer = prepare_map(map, spec, view, 1).value();
            const double water = layer.water.water_at({0, 0});
            EXPECT_EQ(water > 0.6, known.water) << known.name << " " << spacing_m;
            EXPECT_EQ(water < 0.4, !known.water) << known.name << " " << spacing_m;
        }
    }
}

}  // namespace
}  // namespace stormcellar::render
