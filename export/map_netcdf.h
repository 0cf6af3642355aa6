// export/map_netcdf.h -- writes one 2D product of a grid as CF-1.8 netCDF-4, in memory; internal.
//
// The file has the dimensions time (unlimited, one element), y and x, or lat and lon, as grid files
// do (stormcellar/export/grid_netcdf.h). The product is a float variable with a fill value in
// columns without a value. The ancillary variable `status` says for each column why it has no
// value, or that the true value may be larger. A product of a span of time has the bounds
// time_bnds.
//
// Units     As the attributes of the product say.
// Threads   Any thread may call; the netCDF library works for one caller at a time.
// Errors    bad_argument for an invalid spec, or numbers that are not one for each column; internal
//           if netCDF refuses.
// Accuracy  Values are written bit by bit; tests/render/still_netcdf_test.cpp reads them with the
//           netCDF library and with GDAL.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "export/cf_attributes.h"
#include "stormcellar/base/result.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/grid/grid_spec.h"

namespace stormcellar::netcdf {

// A state that a column may have.
struct MapFlag {
    signed char number = 0;
    std::string meaning;  // one word
};

// Values and states are row by row, from the south-west.
struct NetcdfMap {
    const grid::GridSpec& spec;
    UtcTime time;                   // end of the span, if there is one
    std::optional<UtcTime> since;   // start of the span of a product over time
    std::string name;               // of the variable
    CfAttributes attributes;        // of the variable; attributes of place are added
    std::span<const float> values;  // NaN in a column without a value
    std::span<const signed char> states;
    std::vector<MapFlag> flags;
    CfAttributes state_attributes;  // of `status`; flags are added
    CfAttributes file_attributes;
};

[[nodiscard]] Result<std::vector<std::byte>> map_netcdf_bytes(const NetcdfMap& map);

}  // namespace stormcellar::netcdf
