#include "bunzip/run_expander.h"

#include <algorithm>
#include <random>
#include <vector>

#include "tests/bunzip/each_path.h"

namespace stormcellar::bunzip {
namespace {

using Octets = std::vector<std::uint8_t>;

// Expands a block as the format describes it. The last byte of `packed` follows the block and does
// not belong to it.
Octets slowly(const Octets& packed) {
    Octets out;
    std::size_t alike = 0;
    for (std::size_t i = 0; i + 1 < packed.size(); ++i) {
        alike = alike > 0 && packed[i] == out.back() ? alike + 1 : 1;
        out.push_back(packed[i]);
        if (alike < 4) continue;
        ++i;
        out.insert(out.end(), packed[i], Octets::value_type{out.back()});
        alike = 0;
    }
    return out;
}

Octets expand(const Octets& packed, Path path, const std::vector<std::size_t>& pieces) {
    RunExpander expander;
    expander.begin(packed, path);
    Octets out;
    for (std::size_t i = 0; !expander.ended(); ++i) {
        Octets piece(pieces[i % pieces.size()]);
        const std::size_t made = expander.read(piece);
        EXPECT_TRUE(made == piece.size() || expander.ended());
        out.insert(out.end(), piece.begin(), piece.begin() + static_cast<std::ptrdiff_t>(made));
    }
    return out;
}

class RunExpanderOf : public ::testing::TestWithParam<Path> {};
INSTANTIATE_TEST_SUITE_P(EachPath, RunExpanderOf, ::testing::ValuesIn(available_kernels()),
                         test_name);

TEST_P(RunExpanderOf, RunsOfAllLengthsAtAllPlaces) {
    for (std::size_t before = 0; before < 140; ++before) {
        for (const int more : {0, 1, 27, 28, 29, 59, 60, 61, 254, 255}) {
            Octets packed(before);
            for (std::size_t i = 0; i < before; ++i)
                packed[i] = static_cast<std::uint8_t>(i % 7);
            packed.insert(packed.end(), 4, 9);
            packed.push_back(static_cast<std::uint8_t>(more));
            for (std::size_t i = 0; i < 200; ++i)
                packed.push_back(static_cast<std::uint8_t>(i % 5));
            ASSERT_EQ(expand(packed, GetParam(), {2000}), slowly(packed)) << before << ' ' << more;
        }
    }
}

TEST_P(RunExpanderOf, AnyBytesInAnyPieces) {
    std::mt19937 random(5);
    for (int round = 0; round < 400; ++round) {
        Octets packed(1 + random() % 3000);
        // Few kinds of bytes give many runs. Some runs are adjacent, and in some the byte equals
        // the count.
        const auto kinds = static_cast<unsigned>(1 + random() % 6);
        for (std::uint8_t& byte : packed)
            byte = static_cast<std::uint8_t>(random() % kinds + random() % 50 / 49 * 200);
        if (packed.size() > 5) packed[packed.size() - 2] ^= 1U;
        const Octets wanted = slowly(packed);
        ASSERT_EQ(expand(packed, GetParam(), {1 + random() % 40}), wanted) << round;
        ASSERT_EQ(expand(packed, GetParam(), {1 + random() % 4000}), wanted) << round;
        ASSERT_EQ(expand(packed, GetParam(), {1, 1000, 3, 300}), wanted) << round;
    }
}

TEST_P(RunExpanderOf, ABlockThatEndsBeforeACountIsBadAndTakesTheByteBehindIt) {
    RunExpander expander;
    const Octets packed = {1, 7, 7, 7, 7, 3};
    expander.begin(packed, GetParam());
    Octets out(20);
    EXPECT_EQ(expander.read(out), 8U);
    EXPECT_TRUE(expander.ended());
    EXPECT_TRUE(expander.bad());
}

TEST_P(RunExpanderOf, ABlockThatEndsInThreeEqualsOrACountIsGood) {
    for (const Octets& packed : {Octets{7, 7, 7, 1}, Octets{7, 7, 7, 7, 0, 1}, Octets{7, 1}}) {
        RunExpander expander;
        expander.begin(packed, GetParam());
        Octets out(20);
        EXPECT_EQ(expander.read(out), packed.size() == 6 ? 4U : packed.size() - 1);
        EXPECT_TRUE(expander.ended());
        EXPECT_FALSE(expander.bad());
    }
}

}  // namespace
}  // namespace stormcellar::bunzip
