// bunzip/prefix_code.h -- a canonical prefix code: from lengths to a table of lookups.
//
// A code is taken as libbz2 takes it, also where its lengths make no proper code: words are tried
// from the shortest length on, and a word of a length stands for a symbol when it is not above the
// last word of that length. Words that stand for nothing are bad only where they are met.
// Thread contract: const is safe.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "bunzip/bzip2_format.h"

namespace stormcellar::bunzip {

class PrefixCode {
  public:
    static constexpr unsigned lookup_bits = 11;
    static constexpr unsigned length_bits = 4;  // of an entry; the symbol stands above them

    // `lengths`: of each symbol's word, 1 to 20; the last symbol is the end of the block.
    void build(std::span<const std::uint8_t> lengths);

    // By the next lookup_bits bits: symbol and length, or 0 where decode() has to say: longer
    // words, the end of the block, and words that stand for nothing.
    [[nodiscard]] const std::uint16_t* lookup() const { return lookup_.data(); }

    struct Word {
        std::uint16_t symbol = 0;
        std::uint8_t length = 0;  // 0: stands for nothing; that is known after 21 bits
    };
    // `bits`: what follows, the first bit highest, at least 20 of it.
    [[nodiscard]] Word decode(std::uint64_t bits) const;

  private:
    void fill_lookup(std::uint16_t end_symbol);

    // By length: words up to `limit_` stand for symbols; of those, word - base_ is the place in
    // symbols_.
    std::array<std::int32_t, most_code_bits + 1> limit_{};
    std::array<std::int32_t, most_code_bits + 1> base_{};
    std::array<std::uint16_t, most_symbols> symbols_{};  // by length, then by number
    unsigned shortest_ = 0, longest_ = 0;
    std::array<std::uint16_t, std::size_t{1} << lookup_bits> lookup_{};
};

}  // namespace stormcellar::bunzip
