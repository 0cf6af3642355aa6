// Tests that nothing is lost of odd but sound volumes, and that oddities are reported.
#include <algorithm>

#include <gtest/gtest.h>

#include "level2/messages/message_header.h"
#include "stormcellar/level2/decode.h"
#include "tests/level2/wire.h"

namespace stormcellar::level2 {
namespace {

using wire::Bytes;

constexpr std::size_t body_at = message_header_bytes;

Decoded decode_messages(std::initializer_list<Bytes> messages) {
    const Bytes stream = wire::join(messages);
    auto decoded = decode(wire::join({wire::archive_header(), stream}));
    EXPECT_TRUE(decoded) << decoded.error().message;
    return decoded ? std::move(*decoded) : Decoded{};
}

std::vector<std::string> codes_of(const DecodeReport& report) {
    std::vector<std::string> codes;
    for (const Problem& problem : report.problems)
        codes.push_back(problem.code);
    return codes;
}

std::size_t length_of(const Bytes& radials, std::size_t count) {
    return radials.size() / count;
}

TEST(OddVolumes, ASweepOf735Radials) {
    const auto decoded = decode_messages({wire::radial_messages(1, 735)});
    ASSERT_EQ(decoded.volume.sweeps.size(), 1U);
    EXPECT_EQ(decoded.volume.sweeps[0].radials.size(), 735U);
    EXPECT_EQ(decoded.volume.sweeps[0].radials.back().azimuth_number, 735);
    EXPECT_TRUE(decoded.report.complete);
}

// The volume has super-resolution in the lower sweeps and radials of one degree above.
TEST(OddVolumes, HalfAndWholeDegreesMixed) {
    Bytes radials = wire::radial_messages(2, 360);
    const std::size_t length = length_of(radials, 720);
    for (std::size_t i = 0; i < 360; ++i)
        radials[i * length + body_at + 20] = std::byte{1};
    const auto decoded = decode_messages({radials});
    ASSERT_EQ(decoded.volume.sweeps.size(), 2U);
    EXPECT_EQ(decoded.volume.sweeps[0].azimuth_spacing_deg, 0.5F);
    EXPECT_EQ(decoded.volume.sweeps[1].azimuth_spacing_deg, 1.0F);
    EXPECT_TRUE(decoded.report.complete);
}

TEST(OddVolumes, NegativeElevationsKeepTheirSign) {
    wire::Ray ray;
    ray.elevation_deg = -4.66F;
    const auto of = [&](const Bytes& message) {
        return decode_messages({message}).volume.sweeps.at(0).radials.at(0).elevation_deg;
    };
    EXPECT_FLOAT_EQ(of(wire::message_31(ray)), -4.66F);
    EXPECT_NEAR(of(wire::message_1(ray)), -4.66F, 0.003) << "message 1 has steps of 0.0055 degrees";
}

TEST(OddVolumes, TimesMayRunBackwards) {
    Bytes radials = wire::radial_messages(1, 20);
    const std::size_t length = length_of(radials, 20);
    for (std::size_t i = 0; i < 20; ++i)
        wire::overwrite_u32(radials, i * length + body_at + 4,
                            static_cast<std::uint32_t>(3'600'000 - 100 * (i % 7) * i));
    const auto decoded = decode_messages({radials});
    EXPECT_EQ(decoded.volume.radial_count(), 20U);
    EXPECT_EQ(decoded.report.bytes_dropped, 0U);
    EXPECT_TRUE(decoded.report.complete);
}

// Either the time in the message header or the time of the radial may be after midnight while the
// other is before.
TEST(OddVolumes, AVolumeMayCrossMidnight) {
    Bytes radials = wire::radial_messages(1, 20);
    const std::size_t length = length_of(radials, 20);
    for (std::size_t i = 0; i < 20; ++i) {
        const bool after = i >= 10;
        const std::size_t header = i * length;
        wire::overwrite_u16(radials, header + body_at + 8, wire::day + (after ? 1 : 0));
        wire::overwrite_u32(radials, header + body_at + 4,
                            after ? static_cast<std::uint32_t>(i - 10)
                                  : static_cast<std::uint32_t>(86'399'990 + i));
        wire::overwrite_u16(radials, header + 18, wire::day + (i >= 8 && i < 12 ? 1 - after : 0));
    }
    const auto decoded = decode_messages({radials});
    ASSERT_EQ(decoded.volume.radial_count(), 20U);
    const auto& kept = decoded.volume.sweeps.at(0).radials;
    EXPECT_EQ(kept[10].time - kept[9].time, std::chrono::milliseconds{1});
    EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end(),
                               [](const Radial& a, const Radial& b) { return a.time < b.time; }));
}

// AVSET ends a volume before the last cut of its pattern.
TEST(OddVolumes, AVolumeThatAvsetEndsIsComplete) {
    const std::vector<float> pattern = {0.5F, 1.5F, 2.4F, 3.4F, 4.3F, 6.0F, 9.9F};
    const auto decoded =
        decode_messages({wire::vcp_frame(215, pattern), wire::radial_messages(3, 30)});
    EXPECT_EQ(decoded.volume.sweeps.size(), 3U);
    EXPECT_TRUE(decoded.report.complete);
    EXPECT_TRUE(decoded.report.problems.empty());
}

TEST(OddVolumes, AGapInTheElevationNumbersIsNamed) {
    Bytes radials = wire::radial_messages(3, 30);
    const std::size_t sweep = radials.size() / 3;
    const Bytes first(radials.begin(), radials.begin() + static_cast<std::ptrdiff_t>(sweep));
    const Bytes third(radials.begin() + static_cast<std::ptrdiff_t>(2 * sweep), radials.end());
    const auto decoded = decode_messages({first, third});
    EXPECT_EQ(decoded.volume.sweeps.size(), 2U);
    EXPECT_EQ(decoded.volume.sweeps.at(1).elevation_number, 3);
    EXPECT_FALSE(decoded.report.complete);
    EXPECT_EQ(codes_of(decoded.report), std::vector<std::string>{"missing_cuts"});
}

// SAILS and MRLE repeat low elevations as further cuts with the same angle.
TEST(OddVolumes, TheSameAngleTwiceIsTwoCuts) {
    const std::vector<float> pattern = {0.5F, 0.5F, 1.5F, 0.5F, 0.5F};
    const auto decoded =
        decode_messages({wire::vcp_frame(212, pattern), wire::radial_messages(5, 12)});
    ASSERT_EQ(decoded.volume.sweeps.size(), 5U);
    EXPECT_EQ(decoded.volume.sweeps[3].vcp_elevation_deg,
              decoded.volume.sweeps[0].vcp_elevation_deg);
    EXPECT_TRUE(decoded.report.further_volume_starts.empty());
    EXPECT_TRUE(decoded.report.complete);
}

TEST(OddVolumes, ASecondHeaderInTheMiddleBeginsAnotherVolume) {
    const auto decoded =
        decode_messages({wire::radial_messages(2, 12), wire::archive_header("AR2V0006.117"),
                         wire::frame(2), wire::radial_messages(2, 12)});
    EXPECT_EQ(decoded.volume.sweeps.size(), 4U);
    EXPECT_EQ(decoded.report.further_volume_starts, std::vector<std::size_t>{2});
    EXPECT_EQ(decoded.report.bytes_dropped, 0U);
}

TEST(OddVolumes, ARadarThatNobodyKnowsSaysSo) {
    Bytes radial = wire::message_31({});
    radial[body_at] = std::byte{'Q'};  // QTLX is in no table; the file itself has a position
    EXPECT_EQ(std::ranges::count(codes_of(decode_messages({radial}).report), "no_position"), 0);
    const auto old =
        decode(wire::join({wire::archive_header("ARCHIVE2.001", "    "), wire::message_1({})}));
    ASSERT_TRUE(old);
    EXPECT_EQ(std::ranges::count(codes_of(old->report), "no_position"), 1);
}

TEST(OddVolumes, APositionThatDisagreesWithTheTableIsReported) {
    wire::Ray ray;
    Bytes radial = wire::message_31(ray);
    // The volume block is the first block; its latitude is at byte 8.
    const std::size_t pointer_at = body_at + 32;
    const auto low = [&](std::size_t at) { return std::to_integer<std::size_t>(radial[at]); };
    const std::size_t block = body_at + ((low(pointer_at + 2) << 8) | low(pointer_at + 3));
    wire::overwrite_u32(radial, block + 8, 0x42100000);  // 36 degrees
    const auto decoded = decode_messages({radial});
    EXPECT_EQ(std::ranges::count(codes_of(decoded.report), "position_disagrees"), 1);
}

}  // namespace
}  // namespace stormcellar::level2
