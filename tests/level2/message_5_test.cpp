#include "level2/messages/message_5.h"

#include <array>

#include <gtest/gtest.h>

#include "level2/messages/message_header.h"
#include "tests/level2/wire.h"

namespace stormcellar::level2 {
namespace {

constexpr std::array<float, 2> elevations_deg = {0.5F, -0.25F};

TEST(Message5, IsReadFieldByField) {
    const wire::Bytes frame = wire::vcp_frame(212, elevations_deg);
    const auto vcp = read_vcp(5, std::span{frame}.subspan(message_header_bytes));
    ASSERT_TRUE(vcp);
    EXPECT_EQ(vcp->pattern_number, 212);
    EXPECT_EQ(vcp->pattern_type, 2);
    EXPECT_EQ(vcp->version, 1);
    EXPECT_EQ(vcp->clutter_group, 2);
    EXPECT_EQ(vcp->doppler_resolution, 4);
    EXPECT_EQ(vcp->pulse_width, 2);
    EXPECT_EQ(vcp->sequencing, 3);
    EXPECT_TRUE(vcp->is_sails());
    EXPECT_EQ(vcp->sails_count(), 1);
    EXPECT_TRUE(vcp->has_base_tilt());
    ASSERT_EQ(vcp->cuts.size(), 2);
    const VcpCut& cut = vcp->cuts[1];
    EXPECT_NEAR(cut.elevation_deg, -0.25, 0.006);
    EXPECT_EQ(cut.super_resolution, 11);
    EXPECT_EQ(cut.surveillance_pulses, 28);
    EXPECT_EQ(cut.azimuth_rate_code, -2);
    EXPECT_EQ(cut.thresholds_eighth_db[5], 21);
    EXPECT_EQ(cut.supplemental, 0x0213);
    EXPECT_TRUE(cut.is_mpda());
    EXPECT_EQ(cut.rest[5], 3) << "the last byte before the supplemental flags";
    EXPECT_EQ(cut.rest[7], 4) << "a byte after the supplemental flags";
    EXPECT_EQ(cut.rest[21], 11);
}

TEST(Message5, ZerosAndCutsThatAreNotThereArePatternsOfNothing) {
    EXPECT_FALSE(read_vcp(5, wire::Bytes(2404)));
    EXPECT_FALSE(read_vcp(5, {}));
    wire::Bytes frame = wire::vcp_frame(212, elevations_deg);
    wire::overwrite_u16(frame, message_header_bytes + 6, 65535);
    EXPECT_FALSE(read_vcp(5, std::span{frame}.subspan(message_header_bytes)));
}

}  // namespace
}  // namespace stormcellar::level2
