// bunzip/row_links.h -- from the last column of the sorted block to the link of each row.
//
// The rows of the block are its rotations, sorted. The k-th row that begins with a byte is the
// k-th that ends with it, turned by one: so the link of a row, the row that its turning by one
// makes, is found by counting. A link holds the row's first byte too, so that a walk along the
// links reads the block's bytes in their order, one load each.
// Thread contract: pure.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "bunzip/byte_runs.h"
#include "bunzip/paths.h"

namespace stormcellar::bunzip {

// The row linked to, above the row's first byte.
using Link = std::uint32_t;
inline constexpr unsigned link_shift = 8;
// Of those behind the last row that may be written.
inline constexpr std::size_t link_slack = 16;

// `count`: of each byte in `runs`; `links`: as many as all of them, and link_slack.
using LinkRows = void (*)(std::span<const ByteRun> runs,
                          const std::array<std::uint32_t, 256>& count, Link* links);
[[nodiscard]] LinkRows link_rows_by(Path path);

}  // namespace stormcellar::bunzip
