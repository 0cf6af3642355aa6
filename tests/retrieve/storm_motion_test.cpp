// Tests storm motions with winds whose means are known, and with an example of MetPy.
#include "stormcellar/retrieve/storm_motion.h"

#include <cmath>

#include <gtest/gtest.h>

#include "base/degree.h"

namespace stormcellar::retrieve {
namespace {

using Winds = std::vector<WindAtHeight>;

std::vector<WindLayer> layers_up_to(double top_m) {
    std::vector<WindLayer> layers;
    for (double bottom = 0; bottom < top_m; bottom += 200) {
        WindLayer layer{bottom, bottom + 200};
        // Shear of 4 m/s a kilometer toward the east, with 5 m/s from the south.
        layer.wind = LayerWind{.motion = {layer.middle_m() / 250, 5}};
        layers.push_back(layer);
    }
    return layers;
}

std::string refusal(const std::vector<WindLayer>& layers) {
    const auto motions = bunkers_motions(layers);
    return motions ? std::string{} : motions.error().message;
}

TEST(StormMotion, DeviatesAtRightAnglesToTheShear) {
    const auto motions = bunkers_motions(layers_up_to(7'000));
    ASSERT_TRUE(motions) << motions.error().message;
    // The middle of the lowest layer is 100 m above the ground. The wind of this layer is used
    // below its middle too.
    EXPECT_NEAR(motions->mean.u_mps, 12, 0.01);
    EXPECT_NEAR(motions->mean.v_mps, 5, 1e-9);
    EXPECT_NEAR(motions->right.u_mps, motions->mean.u_mps, 1e-9);
    EXPECT_NEAR(motions->right.v_mps, 5 - 7.5, 1e-9);
    EXPECT_NEAR(motions->left.v_mps, 5 + 7.5, 1e-9);
}

// The sounding is the example in the documentation of metpy.calc.bunkers_storm_motion. MetPy
// integrates over pressure, so its mean wind is up to 2.5 knots nearer to the wind at low levels.
// The deviation from the mean is nearly the same.
TEST(StormMotion, AgreesWithMetPy) {
    const std::array<double, 6> heights = {250, 700, 1500, 3100, 5720, 7120};
    const std::array<double, 6> directions = {165, 180, 190, 210, 220, 250};
    const std::array<double, 6> knots = {5, 15, 20, 30, 50, 60};
    Winds winds;
    for (std::size_t i = 0; i < heights.size(); ++i) {
        const double toward = (directions[i] + 180) * degree;
        winds.push_back({heights[i] - 250,
                         {knots[i] * 1852 / 3600 * std::sin(toward),
                          knots[i] * 1852 / 3600 * std::cos(toward)}});
    }
    const auto motions = bunkers_motions(winds);
    ASSERT_TRUE(motions) << motions.error().message;
    const auto expect_knots = [](const Motion& motion, double u, double v, double within) {
        EXPECT_NEAR(motion.u_mps * 3600 / 1852, u, within);
        EXPECT_NEAR(motion.v_mps * 3600 / 1852, v, within);
    };
    expect_knots(motions->right, 22.09618172, 12.43406736, 2.5);
    expect_knots(motions->left, 6.02861839, 36.76517865, 2.5);
    expect_knots(motions->mean, 14.06240005, 24.599623, 2.5);
    expect_knots(
        {motions->right.u_mps - motions->mean.u_mps, motions->right.v_mps - motions->mean.v_mps},
        22.09618172 - 14.06240005, 12.43406736 - 24.599623, 0.2);
}

TEST(StormMotion, IsRefusedWhereTheProfileDoesNotReach) {
    EXPECT_EQ(refusal({}), "no layer has a wind");
    EXPECT_EQ(refusal(layers_up_to(7'000)), "");
    EXPECT_EQ(refusal(layers_up_to(5'600)), "");
    EXPECT_EQ(refusal(layers_up_to(5'400)), "the highest wind is 5.3 km above the radar, not 5.5");
    std::vector<WindLayer> layers = layers_up_to(7'000);
    for (std::size_t i = 0; i < 3; ++i)
        layers[i].wind = tl::unexpected(NoWind::too_few_gates);
    EXPECT_EQ(refusal(layers), "the lowest wind is 0.7 km above the radar, not 0.5");
    layers = layers_up_to(7'000);
    for (std::size_t i = 10; i < 18; ++i)
        layers[i].wind->birds = Birds::likely;
    EXPECT_EQ(refusal(layers), "no wind from 1.9 to 3.7 km above the radar");
    for (std::size_t i = 10; i < 12; ++i)
        layers[i].wind->birds = Birds::possible;
    EXPECT_EQ(refusal(layers), "");
    for (WindLayer& layer : layers)
        layer.wind->birds = Birds::likely;
    EXPECT_EQ(refusal(layers), "all winds are likely those of birds");
}

TEST(StormMotion, IsRefusedWithoutShear) {
    const Winds winds = {{500, {3, 4}}, {3'000, {30, 4}}, {5'500, {3, 4}}};
    const auto motions = bunkers_motions(winds);
    ASSERT_FALSE(motions);
    EXPECT_EQ(motions.error().code, ErrorCode::not_found);
}

TEST(StormMotion, IsWrittenAsTheDirectionThatItComesFrom) {
    const auto motion = parse_motion("240/15");
    ASSERT_TRUE(motion);
    EXPECT_NEAR(motion->u_mps, 15 * std::sin(60 * degree), 1e-9) << "toward the east";
    EXPECT_NEAR(motion->v_mps, 15 * std::cos(60 * degree), 1e-9) << "toward the north";
    EXPECT_EQ(format_motion(*motion), "240/15");
    EXPECT_EQ(format_motion(*parse_motion("0/10")), "0/10");
    EXPECT_EQ(format_motion(*parse_motion("360/12.25")), "0/12.3");
    EXPECT_EQ(format_motion(*parse_motion("359.7/5")), "0/5");
    EXPECT_EQ(format_motion({}), "0/0");
    for (const char* wrong : {"", "240", "240/", "/15", "240/15/3", "361/15", "-1/15", "240/-1",
                              "240/101", "nan/15", "240/15kt", "240 15"})
        EXPECT_FALSE(parse_motion(wrong)) << wrong;
}

TEST(StormMotion, IsSubtractedAlongTheBeam) {
    const Motion storm = *parse_motion("270/10");  // toward the east
    EXPECT_NEAR(storm_relative_mps(25, 90, 0, storm), 15, 1e-9) << "the gate east of the radar";
    EXPECT_NEAR(storm_relative_mps(25, 270, 0, storm), 35, 1e-9);
    EXPECT_NEAR(storm_relative_mps(25, 0, 0, storm), 25, 1e-9);
    EXPECT_NEAR(storm_relative_mps(25, 90, 60, storm), 20, 1e-9);
}

}  // namespace
}  // namespace stormcellar::retrieve
