// Tests profiles of refractivity: formulas, limits, and input that is refused.
#include "stormcellar/grid/refractivity.h"

#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stormcellar/grid/beam_geometry.h"

namespace stormcellar::grid {
namespace {

using ::testing::HasSubstr;

std::string refusal(const std::vector<RefractivityLevel>& levels) {
    const auto profile = RefractivityProfile::from_levels(levels, "test");
    return profile ? "" : profile.error().message;
}

TEST(Refractivity, StandardBendsARayToFourThirdsAtTheGround) {
    for (const double latitude_deg : {-90.0, 0.0, 35.0}) {
        const auto profile = RefractivityProfile::standard(latitude_deg);
        const double radius_m = gaussian_radius_m(latitude_deg);
        const auto ground = profile.at(0);
        EXPECT_EQ(ground.n_units, 313);
        EXPECT_NEAR(1 / radius_m + 1e-6 * ground.gradient_per_m, 3 / (4 * radius_m), 1e-22);
        EXPECT_EQ(profile.at(-400).gradient_per_m, ground.gradient_per_m);
    }
    const auto profile = RefractivityProfile::standard(35);
    EXPECT_NEAR(profile.at(0).gradient_per_m, -0.0392, 5e-5);
    EXPECT_NEAR(profile.at(7970).n_units, 0.25, 0.1);
    EXPECT_EQ(profile.at(8500).n_units, 0);
    EXPECT_EQ(profile.at(8500).gradient_per_m, 0);
}

TEST(Refractivity, ExponentialIsTheReferenceAtmosphere) {
    const auto profile = RefractivityProfile::exponential().value();
    EXPECT_EQ(profile.name(), "exponential N0 313 H 7350 m");
    for (const double height_m : {-400.0, 0.0, 1000.0, 9000.0, 80e3}) {
        const auto air = profile.at(height_m);
        EXPECT_NEAR(air.n_units, 313 * std::exp(-height_m / 7350), 1e-9);
        EXPECT_NEAR(air.gradient_per_m, -313.0 / 7350 * std::exp(-height_m / 7350), 1e-12);
    }
    EXPECT_EQ(RefractivityProfile::exponential(0, 8000).value().at(10).n_units, 0);
    for (const double n_units : {-1.0, 1001.0, std::nan("")})
        EXPECT_FALSE(RefractivityProfile::exponential(n_units, 7350)) << n_units;
    for (const double scale_m : {0.0, 999.0, 1e6, std::nan("")})
        EXPECT_FALSE(RefractivityProfile::exponential(313, scale_m)) << scale_m;
}

// A few levels of an exponential atmosphere reproduce that atmosphere.
TEST(Refractivity, LevelsOfAnExponentialAtmosphereAreThatAtmosphere) {
    const auto reference = RefractivityProfile::exponential().value();
    std::vector<RefractivityLevel> levels;
    for (const double height_m : {100.0, 700.0, 3000.0, 12e3})
        levels.push_back({height_m, reference.at(height_m).n_units});
    const auto profile = RefractivityProfile::from_levels(levels, "sampled").value();
    EXPECT_EQ(profile.name(), "sampled");
    for (int height_m = 100; height_m < 40e3; height_m += 97) {
        EXPECT_NEAR(profile.at(height_m).n_units, reference.at(height_m).n_units, 1e-9);
        EXPECT_NEAR(profile.at(height_m).gradient_per_m, reference.at(height_m).gradient_per_m,
                    1e-12);
    }
}

TEST(Refractivity, IsContinuousAndKeepsItsGradientBelowTheFirstLevel) {
    const std::vector<RefractivityLevel> levels = {{200, 330}, {210, 329},   {300, 260},
                                                   {900, 262}, {900.5, 262}, {5000, 150}};
    const auto profile = RefractivityProfile::from_levels(levels, "test").value();
    for (const RefractivityLevel& level : levels) {
        EXPECT_NEAR(profile.at(level.height_m).n_units, level.n_units, 1e-9);
        EXPECT_NEAR(profile.at(level.height_m - 1e-9).n_units, level.n_units, 1e-8);
    }
    const double gradient = profile.at(200).gradient_per_m;
    EXPECT_NEAR(gradient, -0.1, 1e-3);
    EXPECT_EQ(profile.at(-300).gradient_per_m, gradient);
    EXPECT_NEAR(profile.at(-300).n_units, 330 - 500 * gradient, 1e-9);
    EXPECT_EQ(profile.at(900.2).gradient_per_m, 0);
    EXPECT_NEAR(profile.at(5000 + 7350).n_units, 150 / std::exp(1.0), 1e-9);
}

TEST(Refractivity, GradientIsTheSlopeOfWhatItGives) {
    const auto profile =
        RefractivityProfile::from_levels(
            std::vector<RefractivityLevel>{{0, 350}, {100, 290}, {1000, 270}, {8000, 100}}, "test")
            .value();
    for (const double height_m : {-50.0, 50.0, 500.0, 3000.0, 9000.0}) {
        const double slope =
            (profile.at(height_m + 0.01).n_units - profile.at(height_m - 0.01).n_units) / 0.02;
        EXPECT_NEAR(profile.at(height_m).gradient_per_m, slope, 1e-8) << height_m;
    }
}

TEST(Refractivity, RefusesWhatIsNoAtmosphere) {
    const double nan = std::nan("");
    EXPECT_THAT(refusal({}), HasSubstr("0 levels"));
    EXPECT_THAT(refusal({{0, 300}}), HasSubstr("1 levels"));
    EXPECT_THAT(refusal({{0, 300}, {0, 299}}),
                HasSubstr("level 2: height 0 m is not above the one before"));
    EXPECT_THAT(refusal({{0, 300}, {nan, 299}}), HasSubstr("level 2: height nan"));
    EXPECT_THAT(refusal({{-501, 300}, {10, 299}}), HasSubstr("level 1: height -501"));
    EXPECT_THAT(refusal({{0, 300}, {100'001, 1}}), HasSubstr("level 2: height 100001"));
    EXPECT_THAT(refusal({{9001, 100}, {9500, 90}}), HasSubstr("above 9000"));
    EXPECT_THAT(refusal({{0, 0}, {10, 1}}), HasSubstr("level 1: refractivity 0"));
    EXPECT_THAT(refusal({{0, 300}, {1000, nan}}), HasSubstr("level 2: refractivity nan"));
    EXPECT_THAT(refusal({{0, 1001}, {1000, 100}}), HasSubstr("at most 1000"));
    EXPECT_THAT(refusal({{0, 300}, {1, 297}}), HasSubstr("changes by -3 per meter"));
    EXPECT_EQ(refusal({{0, 300}, {1, 298}}), "");
    std::vector<RefractivityLevel> many;
    for (int i = 0; i < 10'001; ++i)
        many.push_back({static_cast<double>(i), 300});
    EXPECT_THAT(refusal(many), HasSubstr("10001 levels"));
}

TEST(Refractivity, NotANumberStaysNotANumber) {
    EXPECT_TRUE(std::isnan(RefractivityProfile::standard(35).at(std::nan("")).n_units));
    EXPECT_TRUE(
        std::isnan(RefractivityProfile::exponential().value().at(std::nan("")).gradient_per_m));
}

}  // namespace
}  // namespace stormcellar::grid
