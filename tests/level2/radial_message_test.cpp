#include "level2/messages/radial_message.h"

#include <limits>

#include <gtest/gtest.h>

#include "level2/messages/message_header.h"
#include "tests/level2/wire.h"

namespace stormcellar::level2 {
namespace {

std::span<const std::byte> body_of(const wire::Bytes& message) {
    return std::span{message}.subspan(message_header_bytes);
}

TEST(Message31, IsReadFieldByField) {
    wire::Ray ray{.elevation_deg = -0.25F, .status = 3};
    const wire::Bytes bytes = wire::message_31(ray);
    const auto message = read_message_31(body_of(bytes));
    ASSERT_TRUE(message) << message.error();
    EXPECT_EQ(message->icao, "KTLX");
    EXPECT_EQ(message->elevation_number, 1);
    EXPECT_EQ(message->azimuth_spacing_deg, 1.0F);
    EXPECT_EQ(message->vcp, 212);
    const Radial& radial = message->radial;
    EXPECT_EQ(radial.time, time_from_nexrad(wire::day, 3'600'000));
    EXPECT_EQ(radial.azimuth_deg, 10.0F);
    EXPECT_EQ(radial.elevation_deg, -0.25F);
    EXPECT_EQ(radial.status, 3);
    EXPECT_FLOAT_EQ(radial.nyquist_mps, 8.32F);
    EXPECT_EQ(radial.unambiguous_range_m, 466000.0F);
    EXPECT_EQ(radial.horizontal_noise_dbm, -80.0F);
    EXPECT_EQ(radial.vertical_noise_dbm, -81.0F);
    EXPECT_EQ(radial.calibration_dbz, -44.25F);
    EXPECT_EQ(radial.vertical_calibration_dbz, -44.5F);
    EXPECT_EQ(radial.attenuation_db_per_km_thousandths, -12);
    EXPECT_EQ(radial.elevation_calibration_db, -44.25F);
    ASSERT_EQ(message->moments().size(), 2);
    const MomentBlock& rho = message->moments()[1];
    EXPECT_EQ(rho.moment, Moment::rho);
    EXPECT_EQ(rho.gates, 100);
    EXPECT_EQ(rho.first_gate_m, 2125);
    EXPECT_EQ(rho.gate_spacing_m, 250);
    EXPECT_EQ(rho.word_size_bits, 16);
    EXPECT_EQ(rho.scale, 300.0F);
    EXPECT_EQ(rho.offset, -60.5F);
    EXPECT_EQ(rho.folding_threshold_db, 5.0F);
    EXPECT_EQ(rho.snr_threshold_db, 2.0F);
    EXPECT_EQ(rho.codes.size(), 200);
}

TEST(Message31, VolumeBlockIsReadFieldByField) {
    const wire::Bytes bytes = wire::message_31({});
    const auto block = read_volume_block(read_message_31(body_of(bytes))->volume_block);
    ASSERT_TRUE(block);
    EXPECT_EQ(block->latitude_deg, 35.3333F);
    EXPECT_EQ(block->longitude_deg, -97.2778F);
    EXPECT_EQ(block->site_height_m, 370);
    EXPECT_EQ(block->tower_height_m, 20);
    EXPECT_EQ(block->calibration_db, -44.5F);
    EXPECT_EQ(block->initial_differential_phase_deg, 60.0F);
    EXPECT_EQ(block->vcp, 212);
    EXPECT_EQ(block->processing_status, 3);
    EXPECT_TRUE(block->rest.empty());
}

// A message that is cut anywhere is refused, and nothing outside it is read.
TEST(Message31, CutAnywhereIsRefused) {
    const wire::Bytes bytes = wire::message_31({});
    const auto body = body_of(bytes);
    for (std::size_t size = 0; size < body.size(); ++size) {
        const wire::Bytes cut{body.begin(), body.begin() + static_cast<std::ptrdiff_t>(size)};
        EXPECT_FALSE(read_message_31(cut)) << size;
    }
    EXPECT_TRUE(read_message_31(body));
}

TEST(Message31, HugeCountsAndPointersAreRefused) {
    const wire::Bytes good = wire::message_31({});
    wire::Bytes blocks = good;
    wire::overwrite_u16(blocks, 28 + 30, 65535);
    EXPECT_FALSE(read_message_31(body_of(blocks)));
    wire::Bytes pointer = good;
    wire::overwrite_u32(pointer, 28 + 32, 0xFFFFFFFF);
    EXPECT_FALSE(read_message_31(body_of(pointer)));
    wire::Bytes nan = good;
    wire::overwrite_u32(nan, 28 + 24, 0x7FC00000);
    EXPECT_FALSE(read_message_31(body_of(nan)));
}

wire::Bytes moment_with(unsigned gates, unsigned bits, float scale) {
    wire::Writer block;
    block.text("DREF").u32(0).u16(gates).u16(0).u16(250).u16(0).u16(0).u8(0).u8(bits);
    return wire::message_31_with_block(block.f32(scale).f32(66).zeros(100).bytes);
}

TEST(Message31, MomentsThatCannotBeAreRefused) {
    EXPECT_TRUE(read_message_31(body_of(moment_with(100, 8, 2))));
    EXPECT_TRUE(read_message_31(body_of(moment_with(50, 16, 2))));
    EXPECT_FALSE(read_message_31(body_of(moment_with(101, 8, 2)))) << "the gates go beyond the end";
    EXPECT_FALSE(read_message_31(body_of(moment_with(65535, 16, 2))));
    EXPECT_FALSE(read_message_31(body_of(moment_with(50, 12, 2))))
        << "gates of 12 bits do not exist";
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_FALSE(read_message_31(body_of(moment_with(50, 8, nan))));
    EXPECT_TRUE(read_message_31(body_of(moment_with(0, 8, 2)))->moments().empty())
        << "a moment without gates is left out";
}

TEST(Message31, ABlockOfALaterBuildIsSkippedAndGarbageIsNot) {
    const wire::Bytes later = wire::message_31_with_block(wire::Writer{}.text("DXYZ").bytes);
    const auto message = read_message_31(body_of(later));
    ASSERT_TRUE(message);
    EXPECT_EQ(message->unknown_blocks, 1);
    const wire::Bytes garbage = wire::message_31_with_block(wire::Writer{}.u32(0x01020304).bytes);
    EXPECT_FALSE(read_message_31(body_of(garbage)));
}

TEST(Message31, AMomentThatComesTwiceIsRefused) {
    wire::Bytes bytes = wire::message_31({});
    // Replace the pointer to RHO by the pointer to REF.
    const auto ref = std::to_integer<unsigned>(bytes[28 + 32 + 4 * 3 + 3]);
    bytes[28 + 32 + 4 * 4 + 3] = static_cast<std::byte>(ref);
    bytes[28 + 32 + 4 * 4 + 2] = bytes[28 + 32 + 4 * 3 + 2];
    EXPECT_FALSE(read_message_31(body_of(bytes)));
}

TEST(Message1, IsReadFieldByField) {
    wire::Ray ray{.azimuth_deg = 180, .elevation_deg = 1.40625F, .status = 2};
    const wire::Bytes bytes = wire::message_1(ray);
    const auto message = read_message_1(body_of(bytes));
    ASSERT_TRUE(message) << message.error();
    EXPECT_EQ(message->message_type, 1);
    EXPECT_EQ(message->vcp, 21);
    EXPECT_EQ(message->radial.azimuth_deg, 180.0F);
    EXPECT_EQ(message->radial.elevation_deg, 1.40625F);
    EXPECT_EQ(message->radial.status, 2);
    EXPECT_FLOAT_EQ(message->radial.nyquist_mps, 26.32F);
    EXPECT_EQ(message->radial.attenuation_db_per_km_thousandths, 12);
    ASSERT_EQ(message->moments().size(), 3);
    const MomentBlock& vel = message->moments()[1];
    EXPECT_EQ(vel.first_gate_m, -375) << "the range is a signed number";
    EXPECT_EQ(vel.gate_spacing_m, 250);
    EXPECT_EQ(vel.gates, 200);
    EXPECT_EQ(vel.scale, 1.0F) << "resolution 4 is 1 m/s";
    EXPECT_EQ(vel.offset, 129.0F);
    EXPECT_EQ(message->moments()[0].scale, 2.0F);
    EXPECT_EQ(message->moments()[0].offset, 66.0F);
}

TEST(Message1, NegativeElevations) {
    EXPECT_FLOAT_EQ(elevation_from_code(0xFF00), -256 * 180.0F / 32768);
    EXPECT_EQ(elevation_from_code(0), 0.0F);
    EXPECT_EQ(azimuth_from_code(0xC000), 270.0F);
}

TEST(Message1, GatesBeyondTheFrameAreRefused) {
    wire::Bytes bytes = wire::message_1({});
    wire::overwrite_u16(bytes, 28 + 26, 2400);
    EXPECT_FALSE(read_message_1(body_of(bytes)));
    bytes = wire::message_1({});
    wire::overwrite_u16(bytes, 28 + 38, 65535);
    EXPECT_FALSE(read_message_1(body_of(bytes)));
    EXPECT_FALSE(read_message_1({}));
}

}  // namespace
}  // namespace stormcellar::level2
