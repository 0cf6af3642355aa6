// bunzip/row_links.h -- makes the link of each row from the last column of the sorted block.
//
// The rows of the block are its rotations, sorted. The k-th row that begins with a byte is the k-th
// row that ends with it, rotated by one. So the link of a row, which is the row that its rotation
// by one makes, is found by counting. A link also holds the first byte of its row, so that a walk
// along the links reads the bytes of the block in order with one load for each.
//
// Threads   Pure functions.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "bunzip/byte_runs.h"
#include "bunzip/paths.h"

namespace stormcellar::bunzip {

// The linked row, in the bits above the first byte of the row.
using Link = std::uint32_t;
inline constexpr unsigned link_shift = 8;
// Number of links after the last row that may be overwritten.
inline constexpr std::size_t link_slack = 16;

// Links the rows. `count` has the number of each byte in `runs`; `links` has room for all rows and
// link_slack more.
using LinkRows = void (*)(std::span<const ByteRun> runs,
                          const std::array<std::uint32_t, 256>& count, Link* links);
[[nodiscard]] LinkRows link_rows_by(Path path);

}  // namespace stormcellar::bunzip
