// render/map/base_map.h -- the built-in map: coasts, borders, roads, cities.
//
// scripts/make-map-data makes the map from public-domain data (docs/data-sources.md), for the area
// that the weather radars of the United States can see. There are three levels of detail for lines;
// a picture uses one of them.
//
// Format, version 2. Numbers are little-endian; `v` is an unsigned LEB128 number of at most 32
// bits, and `z` is a zigzag number (0, -1, 1, -2...). Longitudes and latitudes are in units of 1/U
// degrees on WGS84.
//
//   offset size
//        0    8  magic "SCBASMAP"
//        8    4  version, 2
//       12    4  CRC-32 of all bytes from 24 on
//       16    8  size of the whole file, including this header
//       24       v U, v number of sets, the sets, v number of cities, the cities
//   set          1 byte layer (MapKind), 1 byte detail, v tolerance in meters, v number of lines, v
//                bytes of all its lines, the lines
//   line         v number of points (at least 2), z west, z south, v width, v height, v bytes of
//                its points; the first point as v east of west, v north of south, each other point
//                as z, z relative to the previous one
//                Lakes and coasts are areas: each of their lines is a closed ring with water (for a
//                lake) or land (for a coast) to its left, inside a tile of 2 by 2 degrees. A part
//                of the ring along the edge of the tile is not a shore.
//   city         v bytes of the name, the name in UTF-8, v population, z latitude, z longitude; the
//                largest first
//
// Threads   Immutable once made. A BaseMap refers to the bytes from which it was made.
// Errors    empty, truncated, corrupt (also by its checksum), unsupported (another version).
//           Contradictions in bytes with a correct checksum are corrupt too; only points_of() finds
//           contradictions among the points of a line.
// Accuracy  As accurate as the sources (docs/data-sources.md). The format adds 1/(2 U) degrees,
//           which is 6 m.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/grid/site_frame.h"

namespace stormcellar::render {

// The numbers are part of the format, so they do not change.
enum class MapKind : std::uint8_t {
    county = 1,
    state = 2,
    lake = 3,
    country = 4,
    coast = 5,
    interstate = 6,
    highway = 7,  // a US highway
};

// A picture (of 796 x 532 pixels) shows the lines of a kind only where the usual distance between
// them is at least `least_px`.
struct MapKindFacts {
    MapKind kind = MapKind::coast;
    std::string_view name;
    double usual_m = 0, least_px = 0;
};
// All kinds in the order in which they are drawn.
inline constexpr auto map_kinds = std::to_array<MapKindFacts>({
    {MapKind::county, "county", 45e3, 30},
    {MapKind::highway, "highway", 33e3, 60},
    {MapKind::interstate, "interstate", 100e3, 40},
    {MapKind::state, "state"},
    {MapKind::lake, "lake"},
    {MapKind::country, "country"},
    {MapKind::coast, "coast"},
});
inline constexpr int map_detail_count = 3;
inline constexpr double map_tile_deg = 2;

// Returns true for the kinds whose lines are the rings of areas.
[[nodiscard]] bool is_area(MapKind kind);
// Returns true if a segment is on the edge of a tile. There the area goes on, so the segment is no
// shore.
[[nodiscard]] bool is_tile_edge(const grid::GeoPoint& from, const grid::GeoPoint& to);

struct MapCity {
    std::string name;
    int population = 0;
    grid::GeoPoint place;
};

// A line: its box, and the bytes of its points.
struct MapLine {
    double west_deg = 0, south_deg = 0, east_deg = 0, north_deg = 0;
    std::uint32_t point_count = 0;
    std::span<const std::byte> points;
};

struct MapSet {
    MapKind kind = MapKind::coast;
    int detail = 0;  // 0: the finest
    double tolerance_m = 0;
    std::vector<MapLine> lines;
};

class BaseMap {
  public:
    // Reads the map in these bytes. The bytes must outlive the map.
    static Result<BaseMap> read(std::span<const std::byte> bytes);
    // Returns the built-in map.
    static Result<BaseMap> built_in();

    [[nodiscard]] const std::vector<MapSet>& sets() const { return sets_; }
    [[nodiscard]] const std::vector<MapCity>& cities() const { return cities_; }
    [[nodiscard]] Result<std::vector<grid::GeoPoint>> points_of(const MapLine& line) const;

  private:
    double degrees_per_unit_ = 1;
    std::vector<MapSet> sets_;
    std::vector<MapCity> cities_;
};

// Returns the bytes of the built-in map.
[[nodiscard]] std::span<const std::byte> built_in_map_bytes();

// The small print under a picture that shows the map.
inline constexpr const char* map_credit = "Map: US Census Bureau, NWS, Natural Earth";

}  // namespace stormcellar::render
