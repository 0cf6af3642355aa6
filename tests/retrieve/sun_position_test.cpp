#include "retrieve/quality/sun_position.h"

#include <gtest/gtest.h>

namespace stormcellar::retrieve {
namespace {

UtcTime at(const char* text) {
    const auto time = parse_utc(text, UtcTime{});
    EXPECT_TRUE(time);
    return time.value_or(UtcTime{});
}

// The example of Reda and Andreas (2004), table A5.1: topocentric zenith angle 50.11162 and azimuth
// 194.34024 degrees at 1830 m near Golden, Colorado.
TEST(SunPosition, AgreesWithThePublishedExample) {
    const SunPosition sun = sun_position(at("2003-10-17T19:30:30Z"), 39.742476, -105.1786);
    EXPECT_NEAR(sun.azimuth_deg, 194.34024, 0.02);
    EXPECT_NEAR(sun.elevation_deg, 90 - 50.11162, 0.02);
}

// Days and places whose sun is known without a table.
TEST(SunPosition, FollowsTheSeasonsAndTheDay) {
    // At the June solstice the sun culminates at 90 - (latitude - 23.44) degrees in the south.
    const SunPosition noon = sun_position(at("2020-06-20T12:01:40Z"), 50, 0);
    EXPECT_NEAR(noon.elevation_deg, 63.44, 0.05);
    EXPECT_NEAR(noon.azimuth_deg, 180, 1);
    EXPECT_LT(sun_position(at("2020-06-20T00:00:00Z"), 50, 0).elevation_deg, -15);
    EXPECT_NEAR(sun_position(at("2020-03-20T06:00:00Z"), 0, 0).azimuth_deg, 90, 1);
    // Refraction lifts the sun by 0.5 degrees at the horizon.
    const SunPosition low = sun_position(at("2020-03-20T06:07:30Z"), 0, 0);
    EXPECT_NEAR(low.elevation_deg, 0.5, 0.15);
}

}  // namespace
}  // namespace stormcellar::retrieve
