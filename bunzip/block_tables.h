// bunzip/block_tables.h -- reads the tables of a block: the bytes that occur in it, the code of
// each group of symbols, and the codes.
//
//   bytes      16 bits for ranges of 16 bytes; for each set bit, 16 bits for the bytes of its range
//   counts     3 bits: number of codes, 2 to 6; 15 bits: number of selectors, at least 1
//   selectors  for each group, the place of its code in a move-to-front list, as ones and a zero
//   codes      for each code, the first length in 5 bits; then for each symbol the changes from the
//              length of the symbol before: 10 is one longer, 11 one shorter, 0 the end
//
// Threads   One thread at a time.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "bunzip/bit_reader.h"
#include "bunzip/bzip2_format.h"
#include "bunzip/prefix_code.h"

namespace stormcellar::bunzip {

struct BlockTables {
    std::array<std::uint8_t, 256> bytes{};  // the bytes that occur, ascending
    unsigned byte_count = 0;
    unsigned code_count = 0;
    std::array<PrefixCode, most_codes> codes;
    std::vector<std::uint8_t> selectors;  // the code of each group

    [[nodiscard]] std::uint16_t end_symbol() const {
        return static_cast<std::uint16_t>(byte_count + 1);
    }
    // Reads the tables, and finds errors in the same order as libbz2.
    [[nodiscard]] Found read(BitReader& reader);

  private:
    [[nodiscard]] Found read_bytes(BitReader& reader);
    [[nodiscard]] Found read_selectors(BitReader& reader);
    [[nodiscard]] Found read_codes(BitReader& reader);
};

}  // namespace stormcellar::bunzip
