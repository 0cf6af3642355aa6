// bunzip/block_tables.h -- reads the tables before the symbols of a block: the bytes that occur in
// it, the code that each group of symbols uses, and the codes.
//
//   16 bits, and 16 more for each of them that is set: the bytes that occur
//   3 bits: number of codes, 2 to 6; 15 bits: number of selectors, at least 1
//   selectors: the code of each group, by move-to-front, as ones that end with a zero
//   codes: for each, 5 bits of the first length; then for each symbol 10 (longer) or 11 (shorter)
//          as often as needed, and 0
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
    std::vector<std::uint8_t> selectors;  // for each group

    [[nodiscard]] std::uint16_t end_symbol() const {
        return static_cast<std::uint16_t>(byte_count + 1);
    }
    // Reads the tables. It finds errors in the same order as libbz2.
    [[nodiscard]] Found read(BitReader& reader);

  private:
    [[nodiscard]] Found read_bytes(BitReader& reader);
    [[nodiscard]] Found read_selectors(BitReader& reader);
    [[nodiscard]] Found read_codes(BitReader& reader);
};

}  // namespace stormcellar::bunzip
