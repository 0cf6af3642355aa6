// bunzip/prefix_code.h -- a canonical prefix code: makes a lookup table from lengths.
//
// A code is read in the same way as by libbz2, even if its lengths make no proper code. Words are
// tried from the shortest length on. A word of a length means a symbol if it is not above the last
// word of that length. Words without a symbol are bad only if they occur.
//
// Threads   Any thread may call const functions.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "bunzip/bzip2_format.h"

namespace stormcellar::bunzip {

class PrefixCode {
  public:
    static constexpr unsigned lookup_bits = 11;
    static constexpr unsigned length_bits = 4;  // of an entry; the symbol is in the bits above

    // Makes the code. `lengths` has the length of each symbol's word, 1 to 20. The last symbol is
    // the end of the block.
    void build(std::span<const std::uint8_t> lengths);

    // The table by the next lookup_bits bits: symbol and length, or 0 if decode() must be called.
    // It must be called for longer words, the end of the block, and words without a symbol.
    [[nodiscard]] const std::uint16_t* lookup() const { return lookup_.data(); }

    struct Word {
        std::uint16_t symbol = 0;
        std::uint8_t length = 0;  // 0: no symbol, which is known after 21 bits
    };
    // Decodes a word. `bits` holds the next bits, the first one highest, at least 20 bits.
    [[nodiscard]] Word decode(std::uint64_t bits) const;

  private:
    void fill_lookup(std::uint16_t end_symbol);

    // By length: words up to `limit_` mean symbols, and word - base_ is the place in symbols_.
    std::array<std::int32_t, most_code_bits + 1> limit_{};
    std::array<std::int32_t, most_code_bits + 1> base_{};
    std::array<std::uint16_t, most_symbols> symbols_{};  // by length, then by number
    unsigned shortest_ = 0, longest_ = 0;
    std::array<std::uint16_t, std::size_t{1} << lookup_bits> lookup_{};
};

}  // namespace stormcellar::bunzip
