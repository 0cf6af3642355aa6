#include "level2/containers/compress_stream.h"

#include <array>
#include <random>

#include <gtest/gtest.h>

#include "stormcellar/level2/decode.h"
#include "tests/level2/same_volume.h"
#include "tests/level2/wire.h"
#include "tests/testing/noise.h"

namespace stormcellar::level2 {
namespace {

using stormcellar::testing::noise;
using wire::Bytes;

Bytes expand_all(CompressStream& stream) {
    Bytes all;
    for (auto piece = stream.next(); !piece.empty(); piece = stream.next())
        all.insert(all.end(), piece.begin(), piece.end());
    return all;
}

TEST(CompressStream, ExpandsWhatCompressMakes) {
    for (const int width : {9, 10, 12, 16}) {
        for (const unsigned values : {1U, 2U, 5U, 256U}) {
            const Bytes plain = noise(700'000, values, 7);
            for (const std::size_t clear_every : {std::size_t{0}, std::size_t{5000}}) {
                const Bytes packed = wire::compress(plain, width, clear_every);
                CompressStream stream{packed};
                ASSERT_EQ(expand_all(stream), plain) << width << ' ' << values;
                EXPECT_EQ(stream.end(), CompressEnd::whole);
                EXPECT_EQ(stream.position(), packed.size());
            }
        }
    }
}

TEST(CompressStream, NothingAndOneByte) {
    for (const std::size_t size : {0U, 1U, 2U}) {
        const Bytes plain = noise(size, 256, 1);
        const Bytes packed = wire::compress(plain, 16, 0);
        CompressStream stream{packed};
        EXPECT_EQ(expand_all(stream), plain);
    }
}

// `own` is the output of compress 4.0 for "ABABABABABABABABABABABAB\n".
TEST(CompressStream, ReadsTheProgramsOwnBytes) {
    constexpr std::array<unsigned, 15> own = {0x1F, 0x9D, 0x90, 0x41, 0x84, 0x04, 0x1C, 0x28,
                                              0xB0, 0x20, 0xC1, 0x83, 0x05, 0x15, 0x00};
    Bytes packed;
    for (const unsigned byte : own)
        packed.push_back(static_cast<std::byte>(byte));
    CompressStream stream{packed};
    EXPECT_EQ(expand_all(stream), wire::Writer{}.text("ABABABABABABABABABABABAB\n").bytes);
}

TEST(CompressStream, ACodeThatCannotBeEndsItAndKeepsWhatCameBefore) {
    const Bytes plain = noise(100'000, 5, 3);
    Bytes packed = wire::compress(plain, 16, 0);
    const auto half = static_cast<std::ptrdiff_t>(packed.size() / 2);
    std::fill(packed.begin() + half, packed.begin() + half + 64, std::byte{0xFF});
    CompressStream stream{packed};
    const Bytes found = expand_all(stream);
    EXPECT_EQ(stream.end(), CompressEnd::corrupt);
    ASSERT_GT(found.size(), 10'000U);
    EXPECT_TRUE(std::equal(found.begin(), found.begin() + 10'000, plain.begin()));
}

TEST(CompressStream, AHeadThatCannotBeIsRefused) {
    const Bytes short_head = {std::byte{0x1F}, std::byte{0x9D}};
    CompressStream cut{short_head};
    EXPECT_TRUE(cut.next().empty());
    EXPECT_EQ(cut.end(), CompressEnd::truncated);
    for (const unsigned flags : {0x88U, 0x91U, 0x80U, 0x9FU}) {
        const Bytes head = {std::byte{0x1F}, std::byte{0x9D}, static_cast<std::byte>(flags),
                            std::byte{0}};
        CompressStream bad{head};
        EXPECT_TRUE(bad.next().empty());
        EXPECT_EQ(bad.end(), CompressEnd::corrupt) << flags;
    }
}

TEST(CompressStream, NoiseNeverHarmsIt) {
    for (unsigned seed = 0; seed < 300; ++seed) {
        Bytes packed = noise(3000, 256, seed);
        packed[0] = std::byte{0x1F};
        packed[1] = std::byte{0x9D};
        packed[2] = static_cast<std::byte>(0x80U | (9U + seed % 8));
        CompressStream stream{packed};
        EXPECT_LT(expand_all(stream).size(), 3000U * 3000U);
    }
}

TEST(CompressStream, AVolumeInItIsDecoded) {
    for (const Bytes& plain : {wire::ldm_volume(2, 20), wire::gzip(wire::ldm_volume(2, 20))}) {
        auto expected = decode(plain).value();
        auto found = decode(wire::compress(plain, 16, 0)).value();
        EXPECT_EQ(difference(found.volume, expected.volume), "");
        EXPECT_TRUE(found.report.complete);
        EXPECT_EQ(found.report.container, "compress+" + expected.report.container);
    }
}

}  // namespace
}  // namespace stormcellar::level2
