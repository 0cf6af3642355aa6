// cache/check.h -- what must be true of a grid file beyond its checksum.
//
// Inside the cache room only. The writer uses the same functions, so it never writes what the
// reader would refuse. Errors are corrupt, with a message that names no file. Thread contract: pure
// functions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "stormcellar/base/result.h"
#include "stormcellar/cache/grid_file.h"
#include "stormcellar/grid/brick_view.h"

namespace stormcellar::cache {

// Checks sizes and numbers of the header: the spec, moment, times (years 1970 to 9999), sites
// (finite) and quantization (1 or 2 bytes, finite, a positive step); at most format::max_bricks
// bricks.
[[nodiscard]] Status check_description(const GridDescription& description,
                                       const grid::Quantization& quantization);

// Checks that every entry is one of the three kinds in its only form: unused fields are zero;
// counts, codes and packed sizes are in range; status blocks are used once each and in order; no
// status block claims a value.
[[nodiscard]] Status check_bricks(std::span<const grid::BrickEntry> bricks,
                                  std::span<const std::byte> states,
                                  const grid::Quantization& quantization, Packing packing);

// How many bytes all stored bricks take together when packed.
[[nodiscard]] std::uint64_t packed_size(std::span<const grid::BrickEntry> bricks);

[[nodiscard]] std::uint64_t brick_count(const grid::GridSpec& spec);

// Count, minimum and maximum of the cells with a value in a brick of codes.
struct CodeRange {
    std::uint16_t value_count = 0;
    std::uint16_t min_code = 0;
    std::uint16_t max_code = 0;
    bool operator==(const CodeRange&) const = default;
};
[[nodiscard]] CodeRange code_range(std::span<const std::byte> codes, int code_bytes);

}  // namespace stormcellar::cache
