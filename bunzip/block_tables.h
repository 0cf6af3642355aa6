// bunzip/block_tables.h -- what stands before the symbols of a block: which bytes it holds, which
// code each group of symbols uses, and the codes.
//
//   16 bits, and 16 more for each that is set: which bytes occur
//   3 bits: codes, 2 to 6; 15 bits: selectors, at least 1
//   selectors: the code of each group, moved to the front, in ones that a zero ends
//   codes: for each, 5 bits of the first length; then for each symbol 10 (longer) and 11 (shorter)
//   as often as needed, and 0
// Thread contract: one thread.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "bunzip/bit_reader.h"
#include "bunzip/bzip2_format.h"
#include "bunzip/prefix_code.h"

namespace stormcellar::bunzip {

struct BlockTables {
    std::array<std::uint8_t, 256> bytes{};  // that occur, ascending
    unsigned byte_count = 0;
    unsigned code_count = 0;
    std::array<PrefixCode, most_codes> codes;
    std::vector<std::uint8_t> selectors;  // by group

    [[nodiscard]] std::uint16_t end_symbol() const {
        return static_cast<std::uint16_t>(byte_count + 1);
    }
    // Errors in the order in which libbz2 meets them.
    [[nodiscard]] Found read(BitReader& reader);

  private:
    [[nodiscard]] Found read_bytes(BitReader& reader);
    [[nodiscard]] Found read_selectors(BitReader& reader);
    [[nodiscard]] Found read_codes(BitReader& reader);
};

}  // namespace stormcellar::bunzip
