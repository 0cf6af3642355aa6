// bunzip/bzip2_format.h -- the numbers of the bzip2 format, and how a part of a stream can end.
//
// A stream: "BZh", a digit (blocks of so many times 100,000 bytes at most), blocks, an end. A
// block: a mark (48 bits), a checksum (32), whether it is randomised (1), the origin (24), its
// tables (block_tables.h), symbols. The end: a mark, the checksum of all blocks' checksums.
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
inline constexpr std::size_t group_symbols = 50;      // that use one code
inline constexpr std::uint32_t most_groups = 18'002;  // selectors behind these are read and dropped
inline constexpr std::uint16_t run_a = 0, run_b = 1;  // symbols; 2 and more: moves to the front
inline constexpr std::size_t most_symbols = 258;      // two of runs, 255 moves, the end
// A run has at most so many digits.
inline constexpr unsigned most_run_digits = 21;

// What reading a part of a stream came to.
enum class Found : std::uint8_t {
    good,
    cut,         // the bytes end inside
    bad,         // they contradict the format
    randomised,  // by bzip2 before 0.9.5: left to libbz2
};

}  // namespace stormcellar::bunzip
