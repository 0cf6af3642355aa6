// web/data/station/station_layout.h -- describes a station's volumes as a tree of Zarr groups
// (version 3), and makes the chunks that need no volume.
//
//   ""                 latitude, longitude, altitude
//   VCP-212            no arrays
//   VCP-212/sweep_0    a place (sweep_places.h): moments and their states (vcp_time, azimuth,
//                      range), facts of radials (vcp_time, azimuth), axes and facts of the sweep
//
// Names, dimensions, types and attributes are those of Python's open_archive(). A chunk has one
// volume. Its fill values say that there is nothing: NaN, no_data, no time.
//
// Units     Degrees, meters.
// Threads   Pure functions.
// Errors    None.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "stormcellar/level2/volume.h"
#include "web/data/station/sweep_chunks.h"
#include "web/data/station/sweep_places.h"
#include "web/data/zarr/zarr_layout.h"

namespace stormcellar::web {

// What the root of the tree tells about the radar.
struct StationFacts {
    std::string station;
    double latitude_deg = 0, longitude_deg = 0, altitude_m = 0;  // NaN: unknown
};
[[nodiscard]] StationFacts station_facts_of(const level2::Volume& volume);

[[nodiscard]] ZarrGroup zarr_root_of(const StationFacts& facts);
[[nodiscard]] ZarrGroup zarr_group_of(const SweepPlace& place, std::size_t times);

// Groups by path, a parent before its children. The path of the root is "".
using ZarrTree = std::vector<std::pair<std::string, ZarrGroup>>;
// Returns the document zarr.json of the group, with all groups and arrays below it.
[[nodiscard]] ZarrJson zarr3_of(const ZarrTree& tree, std::string_view path);

// What an array with times holds: a moment, its states, or a fact of the radials.
struct SweepArray {
    const PlacedMoment* moment = nullptr;  // null: a fact
    bool has_states = false;
    RadialFact fact = RadialFact::time;
};
// Returns none if the place has no such array with times.
[[nodiscard]] std::optional<SweepArray> sweep_array_of(const SweepPlace& place,
                                                       std::string_view name);
// Returns the chunk of an array with times, not compressed; none if it would have only fill values.
[[nodiscard]] std::optional<std::string> chunk_of(const level2::Sweep& sweep,
                                                  const SweepPlace& place, const SweepArray& array);

// Return the only chunk of an array without times, not compressed. The array must exist.
[[nodiscard]] std::string root_chunk(const StationFacts& facts, std::string_view name);
[[nodiscard]] std::string place_chunk(const SweepPlace& place, std::size_t number,
                                      std::string_view name);

}  // namespace stormcellar::web
