// level2/foreign/foreign.h -- decodes files of other formats than Level II into a Volume: ODIM_H5
// (2.0 to 2.4) and CfRadial (1 and 2).
//
// The radials of a sweep are in the order of time, and so are the sweeps. The report's notes say
// how the radar is named, which quantities no moment has room for, and which gates lost something.
//
// Threads   Pure functions.
// Errors    not_level2: HDF5 or netCDF of another kind. corrupt, truncated, unsupported: as for the
//           formats. unsupported: also if the arrays take more than the limit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "stormcellar/base/result.h"
#include "stormcellar/level2/decoded.h"
#include "stormcellar/level2/selection.h"

namespace stormcellar::level2 {

// Returns true for the first bytes of HDF5 and netCDF files.
[[nodiscard]] bool is_foreign(std::span<const std::byte> bytes);

// `fallback_station` names the radar if the file does not.
[[nodiscard]] Result<Decoded> decode_foreign(std::span<const std::byte> bytes,
                                             const Selection& selection,
                                             std::uint64_t most_array_bytes,
                                             const std::string& fallback_station);

}  // namespace stormcellar::level2
