// bunzip/prefix_code.h -- decodes a canonical prefix code that is given by the lengths of its
// words.
//
// Even if the lengths make no proper code, words are decoded in the same way as in libbz2: lengths
// are tried from the shortest on, and bits of a length are a word if they are not above the last
// word of this length. Bits that are no word of any length are an error only if they occur.
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
    static constexpr unsigned length_bits = 4;  // low bits of an entry; the symbol is above

    // Makes the code. `lengths` has the length of each symbol's word, 1 to 20. The last symbol is
    // the end of the block.
    void build(std::span<const std::uint8_t> lengths);

    // Returns the table, whose index is the next lookup_bits bits. An entry holds a symbol and the
    // length of its word. For an entry of 0, call decode(): the bits begin a longer word, the end
    // of the block, or no word.
    [[nodiscard]] const std::uint16_t* lookup() const { return lookup_.data(); }

    struct Word {
        std::uint16_t symbol = 0;
        std::uint8_t length = 0;  // 0: no word
    };
    // Decodes a word. `bits` holds at least the next 20 bits, the first bit highest.
    [[nodiscard]] Word decode(std::uint64_t bits) const;

  private:
    void fill_lookup(std::uint16_t end_symbol);

    // For each length, limit_ is the last word, and word - base_ is the index in symbols_.
    std::array<std::int32_t, most_code_bits + 1> limit_{};
    std::array<std::int32_t, most_code_bits + 1> base_{};
    std::array<std::uint16_t, most_symbols> symbols_{};  // sorted by word length, then number
    unsigned shortest_ = 0, longest_ = 0;
    std::array<std::uint16_t, std::size_t{1} << lookup_bits> lookup_{};
};

}  // namespace stormcellar::bunzip
