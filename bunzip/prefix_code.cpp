#include "bunzip/prefix_code.h"

#include <algorithm>

namespace stormcellar::bunzip {

void PrefixCode::build(std::span<const std::uint8_t> lengths) {
    std::array<std::uint16_t, most_code_bits + 1> count{};
    for (const std::uint8_t length : lengths)
        ++count[length];
    shortest_ = *std::min_element(lengths.begin(), lengths.end());
    longest_ = *std::max_element(lengths.begin(), lengths.end());

    // The first word of a length is twice the number after the last word of the length before.
    std::int32_t next_word = 0, place = 0;
    std::array<std::int32_t, most_code_bits + 1> place_of{};
    for (unsigned length = shortest_; length <= longest_; ++length) {
        base_[length] = next_word - place;
        place_of[length] = place;
        next_word += count[length];
        place += count[length];
        limit_[length] = next_word - 1;
        next_word *= 2;
    }
    for (std::size_t symbol = 0; symbol < lengths.size(); ++symbol)
        symbols_[static_cast<std::size_t>(place_of[lengths[symbol]]++)] =
            static_cast<std::uint16_t>(symbol);
    fill_lookup(static_cast<std::uint16_t>(lengths.size() - 1));
}

// Fills the lookup table. A word of up to lookup_bits bits gets all entries that begin with it. The
// end of the block gets entries of 0, so that the fast loop need not test for it.
void PrefixCode::fill_lookup(std::uint16_t end_symbol) {
    constexpr auto all = std::int32_t{1} << lookup_bits;
    std::int32_t filled = 0;
    for (unsigned length = shortest_; length <= std::min(longest_, lookup_bits); ++length) {
        const unsigned spare = lookup_bits - length;
        for (std::int32_t word = filled >> spare; word <= limit_[length] && filled < all; ++word) {
            const std::uint16_t symbol = symbols_[static_cast<std::size_t>(word - base_[length])];
            const auto entry = static_cast<std::uint16_t>(symbol << length_bits | length);
            std::fill_n(lookup_.begin() + filled, std::int32_t{1} << spare,
                        symbol == end_symbol ? std::uint16_t{0} : entry);
            filled += std::int32_t{1} << spare;
        }
    }
    std::fill(lookup_.begin() + filled, lookup_.end(), std::uint16_t{0});
}

PrefixCode::Word PrefixCode::decode(std::uint64_t bits) const {
    for (unsigned length = shortest_; length <= longest_; ++length) {
        const auto word = static_cast<std::int32_t>(bits >> (64 - length));
        if (word > limit_[length]) continue;
        return {symbols_[static_cast<std::size_t>(word - base_[length])],
                static_cast<std::uint8_t>(length)};
    }
    return {};
}

}  // namespace stormcellar::bunzip
