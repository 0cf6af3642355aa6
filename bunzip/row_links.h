// bunzip/row_links.h -- makes the link of each row from the last column of the sorted block.
//
// The rows are the sorted rotations of the block. The link of a row is the row that comes from
// rotating this row by one byte. The k-th row that begins with a byte, rotated by one, is the k-th
// row that ends with this byte, so counting bytes in the last column gives all links. A link also
// holds the first byte of its row, so that a walk along the links reads the block with one load for
// each byte.
//
// Threads   Pure functions.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "bunzip/byte_runs.h"
#include "bunzip/paths.h"

namespace stormcellar::bunzip {

// A link: the number of the linked row, shifted by link_shift, plus the first byte of the linking
// row.
using Link = std::uint32_t;
inline constexpr unsigned link_shift = 8;
// Number of links after the last row that may be overwritten.
inline constexpr std::size_t link_slack = 16;

// Links the rows. `count` has the number of each byte value in `runs`; `links` must have room for
// all rows and link_slack more.
using LinkRows = void (*)(std::span<const ByteRun> runs,
                          const std::array<std::uint32_t, 256>& count, Link* links);
[[nodiscard]] LinkRows link_rows_by(Path path);

}  // namespace stormcellar::bunzip
