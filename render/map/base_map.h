// render/map/base_map.h -- the map that is built into the library: coasts, borders, cities.
//
// Made by scripts/make-map-data of public-domain data (docs/data-sources.md), for what the weather
// radars of the United States can see. Lines come in three details, of which a picture takes one.
//
// Format, version 1. Little-endian; `v` is an unsigned LEB128 number of at most 32 bits, `z` a
// zigzag one (0, -1, 1, -2...). Longitudes and latitudes are in units of 1/U degrees on WGS84.
//
//   offset size
//        0    8  magic "SCBASMAP"
//        8    4  version, 1
//       12    4  CRC-32 of all bytes from 24 on
//       16    8  size of all, these bytes included
//       24       v U, v number of sets, the sets, v number of cities, the cities
//   set          1 byte layer (MapKind), 1 byte detail, v tolerance in metres,
//                v number of lines, v bytes of all its lines, the lines
//   line         v number of points (at least 2), z west, z south, v width, v height,
//                v bytes of its points; the first as v east of west, v north of south, each other
//                as z, z beyond the one before it
//   city         v bytes of the name, the name in UTF-8, v population, z latitude, z longitude;
//                the largest first
//
// Thread contract: immutable once made. A BaseMap refers to the bytes it was made of.
// Errors: truncated, corrupt (also by its checksum), unsupported (a later version). Bytes that pass
// the checksum and lie are refused too, at the latest by points_of().
// Accuracy: of the sources, see docs/data-sources.md; of the format 1/(2 U) degrees, 6 m.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/grid/site_frame.h"

namespace stormcellar::render {

// Numbers of the format: they do not change. In the order in which they are drawn.
enum class MapKind : std::uint8_t { county = 1, state = 2, lake = 3, country = 4, coast = 5 };
inline constexpr int map_detail_count = 3;

struct MapCity {
    std::string name;
    int population = 0;
    grid::GeoPoint place;
};

// Where a line lies, and the bytes of its points.
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
    // The map in these bytes, which must outlive it.
    static Result<BaseMap> read(std::span<const std::byte> bytes);
    // The map that is built in.
    static Result<BaseMap> built_in();

    [[nodiscard]] const std::vector<MapSet>& sets() const { return sets_; }
    [[nodiscard]] const std::vector<MapCity>& cities() const { return cities_; }
    [[nodiscard]] Result<std::vector<grid::GeoPoint>> points_of(const MapLine& line) const;

  private:
    double degrees_per_unit_ = 1;
    std::vector<MapSet> sets_;
    std::vector<MapCity> cities_;
};

// The bytes of the map that is built in.
[[nodiscard]] std::span<const std::byte> built_in_map_bytes();

// In small print under a picture that shows it.
inline constexpr const char* map_credit = "Map: US Census Bureau, Natural Earth";

}  // namespace stormcellar::render
