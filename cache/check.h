// cache/check.h -- checks the conditions on a grid file beyond its checksum. Used only inside the
// cache room.
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

// Checks the sizes and numbers of the header: the spec, the moment, times (years 1970 to 9999),
// sites (finite) and quantization (1 or 2 bytes, finite, a positive step); and at most
// format::max_bricks bricks.
[[nodiscard]] Status check_description(const GridDescription& description,
                                       const grid::Quantization& quantization);

// Checks that every entry is of one of the three kinds and in the only allowed form: unused fields
// are zero; counts, codes and packed sizes are in range; entries refer to all status blocks, once
// each and in order; and no cell of a status block has the status `value`.
[[nodiscard]] Status check_bricks(std::span<const grid::BrickEntry> bricks,
                                  std::span<const std::byte> states,
                                  const grid::Quantization& quantization, Packing packing);

// Returns the packed size of all stored bricks together.
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
