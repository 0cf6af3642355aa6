#include <cstdint>
#include <span>
#include <string>

#include <gtest/gtest.h>

#include "stormcellar/base/file_system.h"
#include "stormcellar/render/animation.h"
#include "tests/render/decoded_animation.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::render {
namespace {

using ChunkBytes = std::span<const std::byte>;

std::uint32_t number_at(ChunkBytes bytes, std::size_t at) {
    std::uint32_t number = 0;
    for (const std::byte byte : bytes.subspan(at, 4))
        number = number << 8 | std::to_integer<std::uint32_t>(byte);
    return number;
}

// Computes the CRC of the PNG specification (annex D) bit by bit.
std::uint32_t crc_bit_by_bit(ChunkBytes bytes) {
    std::uint32_t crc = 0xFFFFFFFF;
    for (const std::byte byte : bytes) {
        crc ^= std::to_integer<std::uint32_t>(byte);
        for (int bit = 0; bit < 8; ++bit)
            crc = (crc >> 1) ^ ((crc & 1) != 0 ? 0xEDB88320U : 0U);
    }
    return ~crc;
}

class AnimationApng : public ::testing::Test {
  protected:
    void write(const std::vector<Image>& frames, const AnimationOptions& options = {}) {
        write_animation(path(), frames, options);
    }
    [[nodiscard]] std::string path() const { return (directory_ / "a.apng").string(); }
    testing::TemporaryDirectory directory_;
};

TEST_F(AnimationApng, EveryPixelComesBack) {
    const auto frames = test_frames(6);
    write(frames);
    const auto back = decode_with_ffmpeg(path());
    EXPECT_EQ(back.codec, "apng");
    expect_frames(back, frames);
}

TEST_F(AnimationApng, AlphaThatComesAndGoesIsKept) {
    auto frames = test_frames(4);
    frames[1].set(5, 6, {10, 20, 30, 0});
    frames[2].set(7, 6, {10, 20, 30, 100});
    write(frames);
    expect_frames(decode_with_ffmpeg(path()), frames);
}

TEST_F(AnimationApng, IsAPngOfItsFirstFrameForOlderReaders) {
    write(test_frames(3));
    EXPECT_EQ(decode_png_file(path()).rgba, test_frame(0).rgba);
}

TEST_F(AnimationApng, LastFrameStaysLonger) {
    write(test_frames(3), {.frames_per_second = 4, .last_frame_dwell_s = 1.5});
    const auto back = decode_with_ffmpeg(path());
    ASSERT_EQ(back.frames.size(), 3U);
    EXPECT_NEAR(back.frames[1].start_s, 0.25, 1e-6);
    EXPECT_NEAR(back.frames[2].start_s, 0.5, 1e-6);
    EXPECT_NEAR(back.frames[2].duration_s, 1.75, 1e-6);
}

// 2026-11-28: the checksum of IEND, the only chunk without data, was 0; libpng refused the file.
TEST_F(AnimationApng, EveryChunkHasTheChecksumOfThePngSpecification) {
    write(test_frames(3), {.metadata = {{"Title", "KBGM"}}});
    const auto file = read_file(path()).value();
    constexpr std::size_t signature = 8, around_data = 12;
    std::string types;
    for (std::size_t at = signature; at < file.size();) {
        const std::size_t length = number_at(file, at);
        ASSERT_LE(at + around_data + length, file.size());
        const auto type_and_data = ChunkBytes(file).subspan(at + 4, 4 + length);
        const std::string type(reinterpret_cast<const char*>(type_and_data.data()), 4);
        EXPECT_EQ(number_at(file, at + 8 + length), crc_bit_by_bit(type_and_data)) << type;
        types += type + " ";
        at += around_data + length;
    }
    EXPECT_TRUE(types.starts_with("IHDR ") && types.ends_with(" IEND ")) << types;
}

TEST_F(AnimationApng, MetadataIsText) {
    write(test_frames(2), {.metadata = {{"Title", "KBGM"}}});
    EXPECT_EQ(decode_with_ffmpeg(path()).metadata["Title"], "KBGM");
}

}  // namespace
}  // namespace stormcellar::render
