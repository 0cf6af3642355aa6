#include "render/map/base_map.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/render/small_map.h"

namespace stormcellar::render {
namespace {

std::vector<std::byte> built_in() {
    const auto bytes = built_in_map_bytes();
    return {bytes.begin(), bytes.end()};
}

// One line of four points and one city, byte by byte.
const std::vector<std::uint8_t> small_payload = {
    0x90, 0x4E,           // 10000 units a degree
    1,                    // one set:
    5,    0,    120, 1,   //   coast, finest, 120 m, one line
    14,                   //   of 14 bytes
    4,    1,    2,   10,  //     four points, west -1, south 1, width 10,
    20,   8,              //     height 20, 8 bytes
    0,    0,    20,  40,  //     the corner, then 10 east and 20 north,
    1,    1,    1,   1,   //     then one west and one south, twice
    1,                    // one city:
    2,    'A',  'b', 100, 20, 19};

TEST(BaseMap, ASmallMapIsReadAsTheFormatSays) {
    const auto bytes = SmallMap::with_head(small_payload);
    const auto map = BaseMap::read(bytes);
    ASSERT_TRUE(map) << map.error().message;
    ASSERT_EQ(map->sets().size(), 1U);
    const MapSet& set = map->sets()[0];
    EXPECT_EQ(set.kind, MapKind::coast);
    EXPECT_EQ(set.tolerance_m, 120);
    ASSERT_EQ(set.lines.size(), 1U);
    const auto points = map->points_of(set.lines[0]);
    ASSERT_TRUE(points) << points.error().message;
    ASSERT_EQ(points->size(), 4U);
    const double expected[4][2] = {{-1, 1}, {9, 21}, {8, 20}, {7, 19}};
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_NEAR((*points)[i].longitude_deg, expected[i][0] * 1e-4, 1e-12);
        EXPECT_NEAR((*points)[i].latitude_deg, expected[i][1] * 1e-4, 1e-12);
    }
    ASSERT_EQ(map->cities().size(), 1U);
    EXPECT_EQ(map->cities()[0].name, "Ab");
    EXPECT_EQ(map->cities()[0].population, 100);
    EXPECT_NEAR(map->cities()[0].place.latitude_deg, 10e-4, 1e-12);
    EXPECT_NEAR(map->cities()[0].place.longitude_deg, -10e-4, 1e-12);
}

// Replaces each byte of the payload by every other value, with a matching checksum. The reader must
// accept or refuse the map, and must not read beyond its end.
TEST(BaseMap, LiesWithAGoodChecksumAreRefusedOrHarmless) {
    int refused = 0;
    for (std::size_t i = 0; i < small_payload.size(); ++i) {
        for (int value = 0; value < 256; ++value) {
            auto payload = small_payload;
            payload[i] = static_cast<std::uint8_t>(value);
            const auto bytes = SmallMap::with_head(payload);
            const auto map = BaseMap::read(bytes);
            if (!map) {
                EXPECT_EQ(map.error().code, ErrorCode::corrupt);
                ++refused;
                continue;
            }
            for (const MapSet& set : map->sets()) {
                for (const MapLine& line : set.lines)
                    static_cast<void>(map->points_of(line));
            }
        }
    }
    EXPECT_GT(refused, 1000);
}

TEST(BaseMap, TheTestsEncoderWritesTheSame) {
    SmallMap small;
    small.set(MapKind::coast, 0, 120,
              {{{1e-4, -1e-4}, {21e-4, 9e-4}, {20e-4, 8e-4}, {19e-4, 7e-4}}});
    small.city("Ab", 100, {10e-4, -10e-4});
    EXPECT_EQ(small.bytes(), SmallMap::with_head(small_payload));
}

TEST(BaseMap, EveryTruncationIsRefused) {
    const auto whole = SmallMap::with_head(small_payload);
    for (std::size_t size = 0; size < whole.size(); ++size) {
        const auto map = BaseMap::read(std::span(whole).first(size));
        ASSERT_FALSE(map) << size;
        EXPECT_EQ(map.error().code, size == 0 ? ErrorCode::empty : ErrorCode::truncated);
    }
    const auto all = built_in();
    for (std::size_t size = 0; size < all.size(); size += 4999) {
        EXPECT_FALSE(BaseMap::read(std::span(all).first(size))) << size;
    }
}

TEST(BaseMap, EveryFlippedByteIsRefused) {
    auto bytes = SmallMap::with_head(small_payload);
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        for (const int mask : {1, 0x80, 0xFF}) {
            bytes[i] ^= static_cast<std::byte>(mask);
            EXPECT_FALSE(BaseMap::read(bytes)) << i;
            bytes[i] ^= static_cast<std::byte>(mask);
        }
    }
    auto all = built_in();
    for (std::size_t i = 0; i < all.size(); i += 9973) {
        all[i] ^= std::byte{0x10};
        EXPECT_FALSE(BaseMap::read(all)) << i;
        all[i] ^= std::byte{0x10};
    }
    EXPECT_TRUE(BaseMap::read(all));
}

TEST(BaseMap, ALaterVersionIsUnsupported) {
    auto bytes = built_in();
    bytes[8] = std::byte{3};
    const auto map = BaseMap::read(bytes);
    ASSERT_FALSE(map);
    EXPECT_EQ(map.error().code, ErrorCode::unsupported);
}

TEST(BaseMap, TheBuiltInMapIsSmallAndWhole) {
    EXPECT_LT(built_in_map_bytes().size(), 2'500'000U);
    const auto map = BaseMap::built_in();
    ASSERT_TRUE(map) << map.error().message;
    std::set<std::pair<int, int>> sets;
    std::size_t points = 0;
    for (const MapSet& set : map->sets()) {
        sets.insert({static_cast<int>(set.kind), set.detail});
        EXPECT_FALSE(set.lines.empty());
        for (const MapLine& line : set.lines) {
            const auto read = map->points_of(line);
            ASSERT_TRUE(read) << read.error().message;
            points += read->size();
        }
    }
    EXPECT_GT(points, 100'000U);
    EXPECT_EQ(sets.size(), map->sets().size()) << "a set appears twice";
    for (int detail = 0; detail < map_detail_count; ++detail) {
        for (const MapKind kind :
             {MapKind::state, MapKind::lake, MapKind::country, MapKind::coast}) {
            EXPECT_TRUE(sets.contains({static_cast<int>(kind), detail}));
        }
    }
    for (const MapKind kind : {MapKind::county, MapKind::interstate, MapKind::highway})
        EXPECT_TRUE(sets.contains({static_cast<int>(kind), 0}));
}

// Returns the kilometers from a place to the nearest segment of a kind, on a local plane.
double km_to(const BaseMap& map, MapKind kind, int detail, grid::GeoPoint place) {
    const double north = 111.2;
    const double east = north * std::cos(place.latitude_deg * 0.017453292519943295);
    double nearest = 1e9;
    for (const MapSet& set : map.sets()) {
        if (set.kind != kind || set.detail != detail) continue;
        for (const MapLine& line : set.lines) {
            const auto points = map.points_of(line).value();
            for (std::size_t i = 1; i < points.size(); ++i) {
                const double ax = (points[i - 1].longitude_deg - place.longitude_deg) * east;
                const double ay = (points[i - 1].latitude_deg - place.latitude_deg) * north;
                const double dx = (points[i].longitude_deg - points[i - 1].longitude_deg) * east;
                const double dy = (points[i].latitude_deg - points[i - 1].latitude_deg) * north;
                const double share =
                    std::clamp(-(ax * dx + ay * dy) / (dx * dx + dy * dy), 0.0, 1.0);
                nearest = std::min(nearest, std::hypot(ax + share * dx, ay + share * dy));
            }
        }
    }
    return nearest;
}

// Checks places whose positions are known by law or by survey, independently of the sources of the
// map.
TEST(BaseMap, LinesAreWhereTheyAreKnownToBe) {
    const auto map = BaseMap::built_in().value();
    struct Known {
        MapKind kind;
        grid::GeoPoint place;
        double km;
    };
    const Known known[] = {
        {MapKind::state, {36.9990, -109.0452}, 0.5},     // Four Corners monument
        {MapKind::state, {41.0, -104.0}, 1.0},           // Colorado's northern edge
        {MapKind::state, {37.0, -98.0}, 1.0},            // Kansas and Oklahoma
        {MapKind::state, {36.5, -101.0}, 1.0},           // Texas and Oklahoma
        {MapKind::country, {49.0, -110.0}, 1.0},         // the 49th parallel
        {MapKind::country, {32.5343, -117.1228}, 1.0},   // border monument at Tijuana
        {MapKind::country, {65.0, -141.0}, 1.0},         // Alaska and Yukon
        {MapKind::coast, {48.3837, -124.7356}, 2.5},     // Cape Flattery, light
        {MapKind::coast, {25.1, -80.45}, 15},            // Key Largo
        {MapKind::coast, {41.0710, -71.8571}, 1.5},      // Montauk Point, light
        {MapKind::coast, {35.2505, -75.5288}, 1.5},      // Cape Hatteras, light
        {MapKind::coast, {13.6533, 144.8600}, 1.5},      // Ritidian Point, Guam
        {MapKind::lake, {43.3727, -76.6}, 15},           // Lake Ontario's southern shore
        {MapKind::lake, {41.8781, -87.6130}, 2},         // Chicago's lake front
        {MapKind::lake, {43.7450, -81.7280}, 3},         // Goderich, Ontario, light
        {MapKind::lake, {43.6289, -79.3947}, 4},         // Toronto, the island's airport
        {MapKind::lake, {26.9850, -80.6210}, 3},         // Lake Okeechobee, Port Mayaca lock
        {MapKind::lake, {40.7470, -112.1870}, 4},        // Great Salt Lake, Saltair
        {MapKind::lake, {50.6310, -97.0400}, 5},         // Lake Winnipeg, Gimli
        {MapKind::county, {35.3772, -97.6700}, 1.5},     // Oklahoma and Cleveland, Canadian
        {MapKind::interstate, {35.4610, -97.4870}, 1},   // I-35 and I-40, Oklahoma City
        {MapKind::interstate, {39.7795, -104.9892}, 1},  // I-25 and I-70, Denver
        {MapKind::interstate, {39.6783, -105.9200}, 1},  // Eisenhower Tunnel, I-70
        {MapKind::interstate, {40.8517, -73.9527}, 1},   // George Washington Bridge, I-95
        {MapKind::highway, {37.8199, -122.4783}, 1},     // Golden Gate Bridge, US 101
        {MapKind::highway, {24.6983, -81.1667}, 1.5},    // Seven Mile Bridge, US 1
        {MapKind::highway, {36.0161, -114.7377}, 1},     // Hoover Dam, US 93
    };
    for (const Known& k : known) {
        const double km = km_to(map, k.kind, 0, k.place);
        EXPECT_LT(km, k.km) << static_cast<int>(k.kind) << " at " << k.place.latitude_deg << " "
                            << k.place.longitude_deg;
        if (k.kind <= MapKind::coast && k.kind != MapKind::county) {
            EXPECT_LT(km_to(map, k.kind, 2, k.place), k.km + 3.5);
        }
    }
}

// Returns true if a place is within the rings of the coast: a line from the place crosses an odd
// number of edges of the rings.
bool is_land(const BaseMap& map, int detail, grid::GeoPoint place) {
    bool is_within = false;
    for (const MapSet& set : map.sets()) {
        if (set.kind != MapKind::coast || set.detail != detail) continue;
        for (const MapLine& line : set.lines) {
            const auto points = map.points_of(line).value();
            for (std::size_t i = 1; i < points.size(); ++i) {
                const grid::GeoPoint &a = points[i - 1], &b = points[i];
                if ((a.latitude_deg > place.latitude_deg) == (b.latitude_deg > place.latitude_deg))
                    continue;
                const double share =
                    (place.latitude_deg - a.latitude_deg) / (b.latitude_deg - a.latitude_deg);
                if (place.longitude_deg <
                    a.longitude_deg + share * (b.longitude_deg - a.longitude_deg))
                    is_within = !is_within;
            }
        }
    }
    return is_within;
}

// 2026-11-28: the ring of Siberia goes on beyond 180 degrees, but was closed across the whole
// earth. From 65 to 69 degrees north, the map then showed land as sea, and sea as land.
TEST(BaseMap, LandAndSeaAreNotTurnedBesideTheAntimeridian) {
    const auto map = BaseMap::built_in().value();
    for (int detail = 0; detail < map_detail_count; ++detail) {
        for (const grid::GeoPoint place : {grid::GeoPoint{66.56, -145.25},  // Fort Yukon
                                           {67.0, -156.0},                  // Alaska
                                           {67.5, 178.5},                   // Chukotka
                                           {66.3, -175.0},
                                           {71.2, -179.2},  // Wrangel Island, both parts
                                           {71.1, 179.5},
                                           {35.33, -97.28},
                                           {13.45, 144.75}})
            EXPECT_TRUE(is_land(map, detail, place)) << detail << " " << place.latitude_deg;
        for (const grid::GeoPoint place : {grid::GeoPoint{67.7, -168.5},  // Chukchi Sea
                                           {67.8, -172.0},
                                           {66.0, -60.0},  // Davis Strait
                                           {62.0, -175.0},
                                           {71.0, -160.0},
                                           {25.0, -90.0}})
            EXPECT_FALSE(is_land(map, detail, place)) << detail << " " << place.latitude_deg;
    }
}

TEST(BaseMap, CitiesComeLargestFirstAndStandWhereTheyAre) {
    const auto map = BaseMap::built_in().value();
    const auto& cities = map.cities();
    EXPECT_GT(cities.size(), 400U);
    EXPECT_TRUE(std::is_sorted(
        cities.begin(), cities.end(),
        [](const MapCity& a, const MapCity& b) { return a.population > b.population; }));
    const auto city = std::find_if(cities.begin(), cities.end(),
                                   [](const MapCity& c) { return c.name == "Oklahoma City"; });
    ASSERT_NE(city, cities.end());
    EXPECT_NEAR(city->place.latitude_deg, 35.47, 0.02);
    EXPECT_NEAR(city->place.longitude_deg, -97.52, 0.02);
    // A duplicate would be drawn twice.
    std::set<std::pair<long, long>> places;
    for (const MapCity& c : cities) {
        EXPECT_TRUE(places
                        .insert({std::lround(c.place.latitude_deg * 100),
                                 std::lround(c.place.longitude_deg * 100)})
                        .second)
            << c.name;
    }
}

}  // namespace
}  // namespace stormcellar::render
