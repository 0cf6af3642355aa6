// cache/check.h -- checks what a checksum cannot prove: that the contents of a grid file are valid.
// Used only inside the cache room.
//
// The writer and the reader use the same functions, so the writer refuses to write a file that the
// reader would refuse to read.
//
// Threads   Pure functions.
// Errors    corrupt, with a message that names no file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "stormcellar/base/result.h"
#include "stormcellar/cache/grid_file.h"
#include "stormcellar/grid/brick_view.h"

namespace stormcellar::cache {

// Checks that the sizes and numbers of the header are valid: the spec, the moment, times (years
// 1970 to 9999), sites (finite), quantization (1 or 2 bytes, finite, a positive step), and at most
// format::max_bricks bricks.
[[nodiscard]] Status check_description(const GridDescription& description,
                                       const grid::Quantization& quantization);

// Checks that every entry is of one of the three kinds and has the only allowed form. Unused fields
// are zero. Counts, codes and packed sizes are in range. The entries refer to each status block
// once, in the order of the blocks. No cell of a status block has the status `value`.
[[nodiscard]] Status check_bricks(std::span<const grid::BrickEntry> bricks,
                                  std::span<const std::byte> states,
                                  const grid::Quantization& quantization, Packing packing);

// Returns the size of all stored bricks together, as packed.
[[nodiscard]] std::uint64_t packed_size(std::span<const grid::BrickEntry> bricks);

[[nodiscard]] std::uint64_t brick_count(const grid::GridSpec& spec);

// The number of cells with a value in a brick of codes, and their minimum and maximum.
struct CodeRange {
    std::uint16_t value_count = 0;
    std::uint16_t min_code = 0;
    std::uint16_t max_code = 0;
    bool operator==(const CodeRange&) const = default;
};
[[nodiscard]] CodeRange code_range(std::span<const std::byte> codes, int code_bytes);

}  // namespace stormcellar::cache
