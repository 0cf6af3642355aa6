// Tests find_cyclone() with hurricanes whose wind is known, and with volumes that it must refuse.
#include "stormcellar/retrieve/cyclone.h"

#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "base/degree.h"
#include "tests/retrieve/analytic_hurricane.h"

namespace stormcellar::retrieve {
namespace {

tl::expected<Cyclone, NoCyclone> find(const level2::Volume& volume,
                                      const CycloneOptions& options = {}) {
    return find_cyclone(volume, dealias(volume, Dealiasing::anchored), options);
}

AnalyticHurricane hurricane_at(double distance_m, double azimuth_deg, double radius_m,
                               double maximum_mps) {
    AnalyticHurricane hurricane;
    hurricane.center = {distance_m * std::sin(azimuth_deg * degree),
                        distance_m * std::cos(azimuth_deg * degree)};
    hurricane.radius_m = radius_m;
    hurricane.maximum_mps = maximum_mps;
    return hurricane;
}

AnalyticHurricane with(AnalyticHurricane hurricane, HorizontalWind mean, double decay, double wave1,
                       double wave1_azimuth_deg) {
    hurricane.east_mps = mean.east_mps;
    hurricane.north_mps = mean.north_mps;
    hurricane.decay = decay;
    hurricane.wave1 = wave1;
    hurricane.wave1_azimuth_deg = wave1_azimuth_deg;
    return hurricane;
}

CycloneOptions carried_by(const AnalyticHurricane& hurricane) {
    CycloneOptions options;
    options.mean_wind = HorizontalWind{hurricane.east_mps, hurricane.north_mps};
    return options;
}

double off_m(const Cyclone& found, const AnalyticHurricane& hurricane) {
    return std::hypot(found.center_plane.x_m - hurricane.center.x_m,
                      found.center_plane.y_m - hurricane.center.y_m);
}

// Expects that the true wind is within two stated errors for most rings, and within four for all
// rings.
void expect_honest_errors(const Cyclone& found, const AnalyticHurricane& hurricane,
                          const std::string& label) {
    std::size_t within_two = 0;
    for (const CycloneRing& ring : found.rings) {
        const double off =
            std::abs(ring.tangential_mps.value - hurricane.tangential_mps(ring.radius_m));
        EXPECT_LE(off, 4 * ring.tangential_mps.error) << label << ", ring " << ring.radius_m;
        if (off <= 2 * ring.tangential_mps.error) ++within_two;
    }
    EXPECT_GE(static_cast<double>(within_two), 0.9 * static_cast<double>(found.rings.size()))
        << label;
}

class Hurricanes : public ::testing::TestWithParam<double> {};

// The header promises the center within 1 km and the maximum wind within 5 %.
TEST_P(Hurricanes, AreFound) {
    for (const AnalyticHurricane& hurricane :
         {with(hurricane_at(60e3, 35, 15e3, 65), {0, 3}, 0.5, 0, 0),
          with(hurricane_at(60e3, 150, 25e3, 50), {5, 3}, 0.7, 0.1, 140),
          with(hurricane_at(80e3, 265, 15e3, 40), {-4, 6}, 0.7, 0.2, 240),
          with(hurricane_at(80e3, 265, 25e3, 40), {-4, 6}, 0.7, 0.2, 240),
          with(hurricane_at(80e3, 35, 40e3, 65), {0, 3}, 0.5, 0, 0),
          with(hurricane_at(140e3, 150, 15e3, 50), {5, 3}, 0.7, 0.1, 140),
          with(hurricane_at(140e3, 265, 40e3, 40), {-4, 6}, 0.7, 0.2, 240)}) {
        const FoldedVolume folded = hurricane_volume(hurricane, GetParam());
        const auto found = find(folded.volume, carried_by(hurricane));
        ASSERT_TRUE(found) << found.error().text;
        const std::string label = std::to_string(hurricane.radius_m / 1000) + " km, " +
                                  std::to_string(found->distance_m / 1000) + " km away";
        EXPECT_LE(off_m(*found, hurricane), 1000) << label;
        EXPECT_LE(off_m(*found, hurricane), 4 * found->center_error_m) << label;
        const CycloneRing& top = found->maximum();
        EXPECT_NEAR(top.tangential_mps.value, hurricane.maximum_mps, 0.05 * hurricane.maximum_mps)
            << label;
        EXPECT_NEAR(top.radius_m, hurricane.radius_m, 2000) << label;
        EXPECT_NEAR(top.radial_mps.value, -hurricane.inflow_mps, 1) << label;
        EXPECT_NEAR(top.wave1_mps, hurricane.wave1 * hurricane.maximum_mps, 3) << label;
        expect_honest_errors(*found, hurricane, label);
        const double azimuth = std::atan2(hurricane.center.x_m, hurricane.center.y_m);
        EXPECT_NEAR(
            found->along_mps.value,
            hurricane.east_mps * std::sin(azimuth) + hurricane.north_mps * std::cos(azimuth), 1)
            << label;
    }
}
INSTANTIATE_TEST_SUITE_P(Nyquist, Hurricanes, ::testing::Values(12.0, 18.0, 33.0));

// The error due to an unknown mean wind across the beam must stay within the stated error.
TEST(Cyclone, StatesWhatAnUnknownWindAcrossDoes) {
    AnalyticHurricane hurricane = hurricane_at(80e3, 0, 30e3, 50);
    hurricane.east_mps = -6;  // to the left of the beam
    const FoldedVolume folded = hurricane_volume(hurricane, 33);
    const auto unknown = find(folded.volume), known = find(folded.volume, carried_by(hurricane));
    ASSERT_TRUE(unknown && known);
    const CycloneRing &blind = unknown->maximum(), &seeing = known->maximum();
    EXPECT_NEAR(seeing.tangential_mps.value - blind.tangential_mps.value, 6 * 30.0 / 80, 0.3);
    EXPECT_NEAR(blind.across_error_mps, 5 * blind.radius_m / unknown->distance_m, 1e-9);
    EXPECT_GE(blind.tangential_mps.error, blind.across_error_mps);
    EXPECT_LT(seeing.across_error_mps, blind.across_error_mps);
    EXPECT_LE(std::abs(blind.tangential_mps.value - 50), 2 * blind.tangential_mps.error);
    EXPECT_EQ(unknown->across_mps.value, 0);
    EXPECT_NEAR(known->across_mps.value, 6, 0.1);
}

// The true pressure is the integral of the true wind from the outermost ring inward.
TEST(Cyclone, TellsThePressure) {
    const AnalyticHurricane hurricane = hurricane_at(100e3, 200, 25e3, 55);
    const auto found = find(hurricane_volume(hurricane, 25).volume, carried_by(hurricane));
    ASSERT_TRUE(found);
    const double coriolis = 2 * 7.292e-5 * std::sin(found->center.latitude_deg * degree);
    double pascals = 0;
    for (double radius = 50; radius < found->rings.back().radius_m; radius += 100) {
        const double wind = hurricane.tangential_mps(radius);
        pascals += 1.09 * (wind * wind / radius + coriolis * wind) * 100;
    }
    EXPECT_GT(pascals / 100, 30);
    EXPECT_NEAR(found->pressure_deficit_hpa.value, pascals / 100,
                found->pressure_deficit_hpa.error);
    EXPECT_LT(found->pressure_deficit_hpa.error, 0.15 * pascals / 100);
}

TEST(Cyclone, StartsFromAGivenCenter) {
    const AnalyticHurricane hurricane = hurricane_at(90e3, 90, 20e3, 50);
    const FoldedVolume folded = hurricane_volume(hurricane, 25);
    CycloneOptions options;
    options.near = grid::GeoPoint{28.2, -89.2};
    const auto found = find(folded.volume, options);
    ASSERT_TRUE(found);
    EXPECT_LE(off_m(*found, hurricane), 1000);
    options.near = grid::GeoPoint{28, -91.5};
    const auto elsewhere = find(folded.volume, options);
    ASSERT_FALSE(elsewhere) << "the hurricane is 240 km from there";
    EXPECT_EQ(elsewhere.error().reason, NoCycloneReason::no_vortex);
}

TEST(Cyclone, TurnsTheOtherWaySouthOfTheEquator) {
    AnalyticHurricane hurricane = hurricane_at(80e3, 45, 25e3, 50);
    hurricane.rotation = -1;
    FoldedVolume folded = hurricane_volume(hurricane, 25);
    const auto found = find(folded.volume);
    ASSERT_TRUE(found) << found.error().text;
    EXPECT_NEAR(found->maximum().tangential_mps.value, 50, 4);
    folded.volume.block->latitude_deg = 28;
    const auto north = find(folded.volume);
    ASSERT_FALSE(north) << "an anticyclone is no hurricane";
    EXPECT_EQ(north.error().reason, NoCycloneReason::no_vortex);
}

// Wrong fold numbers in a part of the hurricane are put right, and counted.
TEST(Cyclone, RefoldsWhatDoesNotFit) {
    const AnalyticHurricane hurricane = hurricane_at(80e3, 0, 25e3, 50);
    const FoldedVolume folded = hurricane_volume(hurricane, 25);
    Dealiased folds = dealias(folded.volume, Dealiasing::anchored);
    const auto right = find_cyclone(folded.volume, folds);
    const auto stride = static_cast<std::size_t>(folded.volume.sweeps[0].moments[0].gate_stride);
    for (std::size_t radial = 26; radial < 36; ++radial)
        for (std::size_t gate = 280; gate < 320; ++gate)
            ++folds.sweeps[0].folds[radial * stride + gate];
    const auto wrong = find_cyclone(folded.volume, folds);
    ASSERT_TRUE(right && wrong);
    EXPECT_EQ(right->refolded_share, 0);
    EXPECT_GT(wrong->refolded_share, 0);
    EXPECT_NEAR(wrong->maximum().tangential_mps.value, right->maximum().tangential_mps.value, 0.5);
}

NoCycloneReason refusal_of(const level2::Volume& volume, const CycloneOptions& options = {}) {
    const auto found = find(volume, options);
    EXPECT_FALSE(found);
    if (found) return static_cast<NoCycloneReason>(255);
    EXPECT_FALSE(found.error().text.empty());
    return found.error().reason;
}

TEST(NoCyclone, WithoutVelocities) {
    EXPECT_EQ(refusal_of({}), NoCycloneReason::no_velocities);
    FoldedVolume folded = hurricane_volume({}, 25);
    for (std::uint8_t& code : folded.volume.sweeps[0].moments[0].codes8)
        code = 0;
    EXPECT_EQ(refusal_of(folded.volume), NoCycloneReason::no_velocities);
}

TEST(NoCyclone, WithoutNyquistVelocityOrPosition) {
    FoldedVolume folded = hurricane_volume({}, 25);
    level2::Volume nowhere = folded.volume;
    nowhere.block.reset();
    EXPECT_EQ(refusal_of(nowhere), NoCycloneReason::no_position);
    for (level2::Radial& radial : folded.volume.sweeps[0].radials)
        radial.nyquist_mps = 0;
    EXPECT_EQ(refusal_of(folded.volume), NoCycloneReason::no_nyquist);
    folded.volume.sweeps[0].radials[3].nyquist_mps = 25;
    EXPECT_EQ(refusal_of(folded.volume), NoCycloneReason::too_few_velocities);
}

TEST(NoCyclone, BeyondTheReachOfVelocities) {
    CycloneOptions options;
    options.near = grid::GeoPoint{24, -90};
    const auto found = find(hurricane_volume({}, 25).volume, options);
    ASSERT_FALSE(found);
    EXPECT_EQ(found.error().reason, NoCycloneReason::out_of_reach);
    EXPECT_EQ(found.error().text,
              "the center is 443 km from the radar, but velocities reach 230 km");
}

// A uniform wind of 25 m/s looks like a vortex whose wind grows in proportion to the radius.
TEST(NoCyclone, InAUniformWind) {
    AnalyticHurricane calm;
    calm.maximum_mps = 1e-6;
    calm.inflow_mps = 0;
    calm.east_mps = 25;
    EXPECT_EQ(refusal_of(hurricane_volume(calm, 33).volume), NoCycloneReason::no_vortex);
}

TEST(NoCyclone, WithTheRadarInside) {
    EXPECT_EQ(refusal_of(hurricane_volume(hurricane_at(30e3, 60, 40e3, 50), 33).volume),
              NoCycloneReason::radar_inside);
}

TEST(NoCyclone, WhereTheMaximumIsNotSeen) {
    AnalyticHurricane hurricane = hurricane_at(120e3, 60, 60e3, 60);
    FoldedVolume folded = hurricane_volume(hurricane, 33);
    level2::SweepMoment& moment = folded.volume.sweeps[0].moments[0];
    for (std::size_t radial = 0; radial < 720; ++radial) {
        for (std::size_t gate = 0; gate < 912; ++gate) {
            const double azimuth = (static_cast<double>(radial) + 0.5) / 2 * degree;
            const double range = 2000 + 250 * static_cast<double>(gate);
            if (std::hypot(range * std::sin(azimuth) - hurricane.center.x_m,
                           range * std::cos(azimuth) - hurricane.center.y_m) > 45e3)
                moment.codes8[radial * 912 + gate] = 0;
        }
    }
    EXPECT_EQ(refusal_of(folded.volume), NoCycloneReason::no_maximum);
}

TEST(NoCyclone, InOddVolumes) {
    for (const FoldedSpec& spec : {one_gate_spec(), one_legacy_sweep_spec()}) {
        FoldedVolume folded = fold(spec, scattered_mps);
        folded.volume.block.emplace();
        folded.volume.block->latitude_deg = 30;
        folded.volume.block->longitude_deg = -90;
        const Dealiased folds = dealias(folded.volume, Dealiasing::off);
        EXPECT_FALSE(find_cyclone(folded.volume, folds));
        folded.volume.sweeps[0].moments[0].first_gate_m = -375;
        EXPECT_FALSE(find_cyclone(folded.volume, folds));
        for (level2::Radial& radial : folded.volume.sweeps[0].radials)
            radial.azimuth_deg = std::numeric_limits<float>::quiet_NaN();
        EXPECT_FALSE(find_cyclone(folded.volume, folds));
    }
}

}  // namespace
}  // namespace stormcellar::retrieve
