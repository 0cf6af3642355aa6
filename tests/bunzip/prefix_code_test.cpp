#include "bunzip/prefix_code.h"

#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace stormcellar::bunzip {
namespace {

using Lengths = std::vector<std::uint8_t>;

// Decodes bit by bit, as the format describes it. The words of one length are consecutive numbers.
// The first word of the next length is twice the number after the last word of the previous length.
PrefixCode::Word slowly(const Lengths& lengths, std::uint64_t bits) {
    std::uint64_t first = 0;
    for (unsigned length = 1; length <= 20; ++length) {
        std::uint64_t word = first;
        for (std::size_t symbol = 0; symbol < lengths.size(); ++symbol) {
            if (lengths[symbol] != length) continue;
            if (bits >> (64 - length) == word) {
                return {static_cast<std::uint16_t>(symbol), static_cast<std::uint8_t>(length)};
            }
            ++word;
        }
        first = 2 * word;
    }
    return {};
}

PrefixCode::Word by_lookup(const PrefixCode& code, std::uint64_t bits) {
    const unsigned entry = code.lookup()[bits >> (64 - PrefixCode::lookup_bits)];
    return {static_cast<std::uint16_t>(entry >> PrefixCode::length_bits),
            static_cast<std::uint8_t>(entry & 15U)};
}

void expect_slow_code(const Lengths& lengths, std::mt19937_64& random) {
    PrefixCode code;
    code.build(lengths);
    for (int i = 0; i < 3000; ++i) {
        // Many leading ones give long words.
        const auto ones = static_cast<unsigned>(random() % 24);
        std::uint64_t bits = random() >> ones;
        if (ones > 0) bits |= ~std::uint64_t{0} << (64 - ones);
        const PrefixCode::Word wanted = slowly(lengths, bits), word = code.decode(bits);
        ASSERT_EQ(word.length, wanted.length) << std::hex << bits;
        ASSERT_EQ(word.symbol, wanted.symbol) << std::hex << bits;
        const PrefixCode::Word looked_up = by_lookup(code, bits);
        const bool left_to_decode = wanted.length == 0 || wanted.length > PrefixCode::lookup_bits ||
                                    wanted.symbol + 1U == lengths.size();
        ASSERT_EQ(looked_up.length, left_to_decode ? 0 : wanted.length) << std::hex << bits;
        if (!left_to_decode) {
            ASSERT_EQ(looked_up.symbol, wanted.symbol);
        }
    }
}

void expect_slow_codes_of_lengths(unsigned least, unsigned most, std::mt19937_64& random) {
    for (int round = 0; round < 100; ++round) {
        Lengths lengths(3 + random() % 256);
        for (std::uint8_t& length : lengths)
            length = static_cast<std::uint8_t>(least + random() % (most - least + 1));
        expect_slow_code(lengths, random);
    }
}

TEST(PrefixCode, ProperCodes) {
    std::mt19937_64 random(1);
    expect_slow_code({1, 2, 2}, random);
    expect_slow_code({3, 3, 3, 3, 3, 3, 3, 3}, random);
    expect_slow_code(Lengths(256, 8), random);
    // This code has words of every length, up to the longest possible.
    expect_slow_code({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 20},
                     random);
    expect_slow_code({20, 20, 19, 18, 17, 16, 15, 14, 13, 12, 11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1},
                     random);
}

TEST(PrefixCode, LengthsThatLeaveWordsUnused) {
    std::mt19937_64 random(2);
    expect_slow_code({2, 2, 2}, random);
    expect_slow_code({20, 20, 20}, random);
    expect_slow_code({4, 12, 9, 17}, random);
    expect_slow_codes_of_lengths(9, 20, random);
}

// There are more words than fit, so words of longer lengths are never decoded.
TEST(PrefixCode, LengthsThatAreTooShort) {
    std::mt19937_64 random(3);
    expect_slow_code({1, 1, 1}, random);
    expect_slow_code({1, 1, 2, 3, 20}, random);
    expect_slow_code(Lengths(258, 1), random);
    expect_slow_codes_of_lengths(1, 20, random);
}

TEST(PrefixCode, IsBuiltAnew) {
    std::mt19937_64 random(4);
    PrefixCode code;
    code.build(Lengths(258, 9));
    code.build(Lengths{20, 20, 20});
    EXPECT_EQ(code.decode(~std::uint64_t{0}).length, 0);
    EXPECT_EQ(code.decode(0).length, 20);
    EXPECT_EQ(code.lookup()[0], 0);
}

}  // namespace
}  // namespace stormcellar::bunzip
