// export/grib_map.h -- writes one 2D product of a grid as GRIB2, in memory; internal.
//
// The file has two messages on the same grid. The first has the values, with a bitmap for columns
// without one. The second has the states of the columns, in parameter 192 of the same category;
// GRIB2 leaves this parameter to local use. Section 2 (local use) of both is text, one "name:
// value" a line. The originating center is "missing" (255).
//
// A grid in latitude and longitude has template 3.0; a Lambert grid has template 3.30. GRIB2 has no
// template for azimuthal_equidistant about any place. Rows run from south to north. Values are
// packed simply, in 16 bits (template 5.0).
//
// ecCodes is in the module stormcellar_grib.so, which is loaded when the first file is written.
//
// Units     Those of the parameter in WMO's code table 4.2.
// Threads   Any thread may call; ecCodes works for one caller at a time.
// Errors    bad_argument for an invalid spec, numbers that are not one for each column, and no
//           value at all; unsupported for a projection without a template, a build without ecCodes
//           (STORMCELLAR_GRIB) and a module that cannot be loaded; internal if ecCodes refuses.
// Accuracy  Values: 1/65,000 of their range. Places: 1e-6
//           degrees, and half of that for each column or row of a grid in degrees.
// Source    WMO Manual on Codes, volume I.2, FM 92 GRIB edition 2, tables of version 28.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/grid/grid_spec.h"

namespace stormcellar::grib {

// A row of WMO's code table 4.2, and one of table 4.5.
struct Parameter {
    int discipline = 0, category = 0, number = 0;
    int surface = 0;  // 10: entire atmosphere, 102: height above mean sea level, 1: ground
    std::optional<double> height_m = {};  // of surface 102
};

// Values and states are row by row, from the south-west.
struct Map {
    const grid::GridSpec& spec;
    Parameter parameter;
    UtcTime time;                   // end of the span, if there is one
    std::optional<UtcTime> since;   // start of the span of a sum
    std::span<const float> values;  // NaN in a column without a value
    std::span<const std::uint8_t> states;
    std::vector<std::pair<std::string, std::string>> notes;
};

[[nodiscard]] Result<std::vector<std::byte>> map_bytes(const Map& map);

// The function that the module exports, with C linkage.
using MapEntry = void (*)(const Map& map, Result<std::vector<std::byte>>& bytes);
inline constexpr const char* module_file = "stormcellar_grib.so";
inline constexpr const char* module_entry = "stormcellar_grib_map";

}  // namespace stormcellar::grib
