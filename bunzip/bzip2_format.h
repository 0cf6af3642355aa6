// bunzip/bzip2_format.h -- constants of the bzip2 format, and the results of reading a part of a
// stream.
//
// A stream has "BZh", a digit d (blocks have at most d times 100,000 bytes), blocks, and an end. A
// block has a mark (48 bits), a checksum (32), a flag for randomized blocks (1), the origin (24),
// its tables (block_tables.h), and symbols. The end has a mark and the checksum of the checksums of
// all blocks.
#pragma once

#include <cstddef>
#include <cstdint>

namespace stormcellar::bunzip {

inline constexpr std::uint64_t block_mark = 0x314159265359;
inline constexpr std::uint64_t end_mark = 0x177245385090;
inline constexpr unsigned mark_bits = 48;

inline constexpr std::uint32_t block_unit = 100'000;
inline constexpr std::uint32_t most_rows = 9 * block_unit;

inline constexpr unsigned most_code_bits = 20;
inline constexpr unsigned least_codes = 2, most_codes = 6;
inline constexpr std::size_t group_symbols = 50;      // symbols in a group; a group uses one code
inline constexpr std::uint32_t most_groups = 18'002;  // further selectors are read and dropped
inline constexpr std::uint16_t run_a = 0, run_b = 1;  // symbols; 2 and more are moves to the front
inline constexpr std::size_t most_symbols = 258;      // two for runs, 255 moves, the end
// A run has at most this many digits.
inline constexpr unsigned most_run_digits = 21;

// The result of reading a part of a stream.
enum class Found : std::uint8_t {
    good,
    cut,         // the bytes end inside the part
    bad,         // the bytes contradict the format
    randomised,  // a block as made by bzip2 before 0.9.5; only libbz2 reads it
};

}  // namespace stormcellar::bunzip
