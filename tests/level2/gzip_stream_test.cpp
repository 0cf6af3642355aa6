#include "level2/containers/gzip_stream.h"

#include <gtest/gtest.h>

#include "tests/level2/wire.h"

namespace stormcellar::level2 {
namespace {

wire::Bytes pattern(std::size_t size) {
    wire::Bytes bytes(size);
    for (std::size_t i = 0; i < size; ++i)
        bytes[i] = static_cast<std::byte>((i * i >> 3) & 0xFFU);
    return bytes;
}

wire::Bytes inflate_all(GzipStream& gzip) {
    wire::Bytes all;
    for (auto piece = gzip.next(); !piece.empty(); piece = gzip.next())
        all.insert(all.end(), piece.begin(), piece.end());
    return all;
}

TEST(GzipStream, GivesMembersOneBehindTheOtherAndIgnoresPadding) {
    const wire::Bytes plain = pattern(1'000'000);
    const wire::Bytes packed = wire::gzip(plain);
    const wire::Bytes all = wire::join({packed, packed, wire::Bytes(512)});
    GzipStream gzip{all};
    EXPECT_EQ(inflate_all(gzip), wire::join({plain, plain}));
    EXPECT_EQ(gzip.end(), GzipEnd::whole);
}

TEST(GzipStream, GivesWhatComesBeforeACut) {
    const wire::Bytes plain = pattern(1'000'000);
    wire::Bytes packed = wire::gzip(plain);
    packed.resize(packed.size() / 2);
    GzipStream gzip{packed};
    const wire::Bytes found = inflate_all(gzip);
    EXPECT_EQ(gzip.end(), GzipEnd::truncated);
    ASSERT_GT(found.size(), 1000);
    EXPECT_TRUE(std::equal(found.begin(), found.end(), plain.begin()));
}

TEST(GzipStream, AWrongChecksumLosesNothing) {
    const wire::Bytes plain = pattern(10'000);
    wire::Bytes packed = wire::gzip(plain);
    packed[packed.size() - 8] ^= std::byte{1};
    GzipStream gzip{packed};
    EXPECT_EQ(inflate_all(gzip), plain);
    EXPECT_EQ(gzip.end(), GzipEnd::bad_checksum);
}

TEST(GzipStream, TellsDamageAndGarbageApart) {
    wire::Bytes packed = wire::gzip(pattern(100'000));
    const wire::Bytes trailed = wire::join({packed, wire::Writer{}.text("garbage").bytes});
    GzipStream trailing{trailed};
    EXPECT_EQ(inflate_all(trailing).size(), 100'000);
    EXPECT_EQ(trailing.end(), GzipEnd::trailing_garbage);
    packed[10] = std::byte{0xFF};  // a block type that does not exist
    GzipStream damaged{packed};
    EXPECT_TRUE(inflate_all(damaged).empty());
    EXPECT_EQ(damaged.end(), GzipEnd::corrupt);
}

TEST(GzipStream, GzipIsPeeledAndNothingElse) {
    const wire::Bytes record = pattern(10'000);
    EXPECT_EQ(without_gzip(wire::gzip(record)), record);
    EXPECT_EQ(without_gzip(record), record);
    EXPECT_TRUE(without_gzip({}).empty());
}

}  // namespace
}  // namespace stormcellar::level2
