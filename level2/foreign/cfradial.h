// level2/foreign/cfradial.h -- volumes of CfRadial 1 (one group) and CfRadial 2 (a group for each
// sweep, also known as WMO FM 301).
//
// Files that this program wrote give back their codes: level2_scale and level2_offset of a field
// are its packing, and the field NAME_status has the states. In other files, an element with the
// fill value is below threshold.
//
// Threads   Pure functions.
// Errors    unsupported: a moving platform, or no sweep at a fixed elevation. corrupt: nothing
//           readable.
// Source    CfRadial 1.4 and 2.0 (NCAR/EOL); WMO Manual on Codes, FM 301.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "arrayfile/array_file.h"
#include "level2/foreign/polar_file.h"
#include "stormcellar/base/result.h"

namespace stormcellar::level2 {

[[nodiscard]] bool is_cfradial(const arrayfile::Group& root);
// Reads coordinates and facts from the bytes of the tree. The result refers to the tree, which must
// outlive it.
[[nodiscard]] Result<PolarFile> read_cfradial(std::span<const std::byte> bytes,
                                              const arrayfile::Group& root,
                                              std::uint64_t most_bytes);

}  // namespace stormcellar::level2
