#include "bunzip/bunzip_c.h"

#include <string>

#include <gtest/gtest.h>

#include "bunzip/paths.h"
#include "tests/bunzip/stream_maker.h"

namespace stormcellar::bunzip {
namespace {

class BunzipC : public ::testing::Test {
  protected:
    ~BunzipC() override { bunzip_workspace_free(workspace_); }
    bunzip_status decompress(const Bytes& stream, std::size_t room) {
        out_.assign(room, '?');
        return bunzip_decompress(workspace_, stream.data(), stream.size(), out_.data(), room,
                                 &made_, &taken_);
    }
    bunzip_workspace* workspace_ = bunzip_workspace_new();
    std::string out_;
    std::size_t made_ = 99, taken_ = 99;
};

TEST_F(BunzipC, AWholeStream) {
    const Bytes stream = compressed(bytes_of("a banana"), 9);
    EXPECT_EQ(decompress(stream, 20), BUNZIP_WHOLE);
    EXPECT_EQ(out_.substr(0, made_), "a banana");
    EXPECT_EQ(out_[made_], '?');
    EXPECT_EQ(taken_, stream.size());
    EXPECT_EQ(decompress(stream, 8), BUNZIP_WHOLE);
}

TEST_F(BunzipC, NoRoom) {
    const Bytes stream = compressed(bytes_of("a banana"), 9);
    EXPECT_EQ(decompress(stream, 7), BUNZIP_TOO_LARGE);
    EXPECT_EQ(out_.substr(0, made_), "a banan");
    EXPECT_EQ(
        bunzip_decompress(workspace_, stream.data(), stream.size(), nullptr, 0, &made_, &taken_),
        BUNZIP_TOO_LARGE);
    const Bytes nothing = compressed({}, 9);
    EXPECT_EQ(
        bunzip_decompress(workspace_, nothing.data(), nothing.size(), nullptr, 0, &made_, &taken_),
        BUNZIP_WHOLE);
    EXPECT_EQ(made_, 0U);
}

TEST_F(BunzipC, NoWorkspace) {
    const Bytes stream = compressed(bytes_of("a banana"), 9);
    made_ = taken_ = 7;
    EXPECT_EQ(
        bunzip_decompress(nullptr, stream.data(), stream.size(), out_.data(), 8, &made_, &taken_),
        BUNZIP_NO_MEMORY);
    EXPECT_EQ(made_ + taken_, 0U);
}

TEST_F(BunzipC, CutAndDamaged) {
    Bytes stream = compressed(bytes_of("a banana"), 9);
    stream.pop_back();
    EXPECT_EQ(decompress(stream, 20), BUNZIP_TRUNCATED);
    EXPECT_EQ(decompress({}, 20), BUNZIP_TRUNCATED);
    stream[0] = std::byte{'X'};
    EXPECT_EQ(decompress(stream, 20), BUNZIP_CORRUPT);
    EXPECT_EQ(made_, 0U);
}

TEST_F(BunzipC, Paths) {
    const std::string before = bunzip_path();
    EXPECT_EQ(bunzip_use_path("libbz2"), 1);
    EXPECT_STREQ(bunzip_path(), "libbz2");
    EXPECT_EQ(decompress(compressed(bytes_of("a banana"), 9), 20), BUNZIP_WHOLE);
    EXPECT_EQ(bunzip_use_path("abacus"), 0);
    EXPECT_EQ(bunzip_use_path(nullptr), 0);
    EXPECT_STREQ(bunzip_path(), "libbz2");
    EXPECT_EQ(bunzip_use_path(before.c_str()), 1);
}

}  // namespace
}  // namespace stormcellar::bunzip
