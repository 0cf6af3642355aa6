#include "bunzip/bzip2_checksum.h"

#include <random>

#include "tests/bunzip/each_path.h"
#include "tests/bunzip/stream_maker.h"
#include "tests/testing/noise.h"

namespace stormcellar::bunzip {
namespace {

class ChecksumOf : public ::testing::TestWithParam<Path> {
  protected:
    [[nodiscard]] static std::uint32_t go_on(std::uint32_t state, std::span<const std::byte> from) {
        return checksum_by(GetParam())(
            state, {reinterpret_cast<const std::uint8_t*>(from.data()), from.size()});
    }
};
INSTANTIATE_TEST_SUITE_P(EachPath, ChecksumOf, ::testing::ValuesIn(available_kernels()), test_name);

// This is the check value of CRC-32/BZIP2 in the catalog of parametrized CRC algorithms.
TEST_P(ChecksumOf, TheNineDigits) {
    EXPECT_EQ(~go_on(checksum_begin, bytes_of("123456789")), 0xFC891918U);
    EXPECT_EQ(slow_checksum(bytes_of("123456789")), 0xFC891918U);
}

TEST_P(ChecksumOf, AnyLengthAsBitByBit) {
    const Bytes bytes = stormcellar::testing::noise(4200, 256, 3);
    for (std::size_t size = 0; size <= bytes.size(); size += size < 300 ? 1 : 61) {
        const auto part = std::span{bytes}.first(size);
        ASSERT_EQ(~go_on(checksum_begin, part), slow_checksum(part)) << size;
    }
}

TEST_P(ChecksumOf, GoesOnFromPieceToPiece) {
    std::mt19937 random(4);
    const Bytes bytes = stormcellar::testing::noise(10'000, 256, random);
    std::uint32_t state = checksum_begin;
    for (std::size_t at = 0; at < bytes.size();) {
        const std::size_t piece = std::min<std::size_t>(random() % 700, bytes.size() - at);
        state = go_on(state, std::span{bytes}.subspan(at, piece));
        at += piece;
    }
    EXPECT_EQ(~state, slow_checksum(bytes));
}

}  // namespace
}  // namespace stormcellar::bunzip
