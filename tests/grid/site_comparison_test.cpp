// Two radars see the same simulated weather, and one of them has a fault. Tests that the fault is
// found.
#include "grid/judge/site_comparison.h"

#include <chrono>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stormcellar/grid/brick_grid.h"
#include "stormcellar/grid/gridder.h"
#include "stormcellar/level2/decode.h"
#include "synth/observe.h"
#include "tests/grid/volume_maker.h"
#include "tests/testing/two_radars.h"

namespace stormcellar::grid {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr UniformMotion motion{testing::storms_east_mps, testing::storms_north_mps};
constexpr int seconds_of_fault = 30;

struct Radar {
    level2::Volume volume;
    SitePosition site;
};

Radar radar_at(const char* station, double longitude_deg, unsigned seed) {
    const auto scene =
        synth::parse_scene(testing::scene_of_nine_storms(station, longitude_deg, seed), station);
    EXPECT_TRUE(scene) << scene.error().message;
    return {synth::observe(*scene, 0), {station, 35, longitude_deg, 380}};
}

struct Gridded {
    BrickGrid bricks;
    Grid grid;  // the view's details point here
    SitePosition site;

    [[nodiscard]] SiteGrid as_site() const { return {bricks.view(), site, &grid.details}; }
};

GridSpec domain() {
    GridSpec spec = default_spec(35, -97);
    spec.nx = 240;
    spec.ny = 300;
    spec.levels_m.resize(24);
    return spec;
}

Gridded gridded(const Radar& radar, const GridSpec& spec, UtcTime instant) {
    const auto geometry = make_column_geometry(radar.site, spec);
    EXPECT_TRUE(geometry);
    GridderOptions options;
    options.frame_time = instant;
    options.details.add(Detail::age);
    auto grid = make_grid(radar.volume, radar.site, **geometry, options);
    EXPECT_TRUE(grid);
    BrickGrid bricks = BrickGrid::from(*grid, default_quantization(level2::Moment::ref));
    return {std::move(bricks), std::move(*grid), radar.site};
}

// Makes the weather once for all tests. The sites are 110 km apart.
class SiteComparisonTest : public ::testing::Test {
  protected:
    static void SetUpTestSuite() {
        b_ = new Radar(radar_at("XSYB", -96.4, 2));
        const Radar a = radar_at("XSYA", -97.6, 1);
        instant_ = *a.volume.start_time() + std::chrono::seconds{60};
        good_ = new Gridded(gridded(a, domain(), instant_));
    }
    static void TearDownTestSuite() {
        delete good_;
        delete b_;
    }

    static SiteComparison compared(const Radar& b, std::optional<UniformMotion> moves = motion) {
        const Gridded other = gridded(b, domain(), instant_);
        ComparisonOptions options{.motion = moves};
        const auto found = compare_sites(good_->as_site(), other.as_site(), options);
        EXPECT_TRUE(found);
        if (found) print(*found);
        return found ? *found : SiteComparison{};
    }
    static void print(const SiteComparison& of) {
        const auto text = [](const Estimate& estimate) {
            return estimate.untold.empty()
                       ? fmt::format("{:.3f}+-{:.3f}", estimate.value, estimate.standard_error)
                       : "(" + estimate.untold + ")";
        };
        fmt::print(
            "{}/{}: bias {} dB, azimuth {}, elevation {}, time {} s; {} cells, {} blocks, "
            "{:.2f} dB\n",
            of.b, of.a, text(of.bias_db), text(of.azimuth_deg), text(of.elevation_deg),
            text(of.time_s), of.cells, of.blocks, of.deviation_db);
    }
    // Checks the estimates within the accuracy that the header states.
    static void expect(const SiteComparison& found, double bias_db, double azimuth_deg,
                       double elevation_deg, double time_s) {
        EXPECT_NEAR(found.bias_db.value, bias_db, 0.4);
        EXPECT_NEAR(found.azimuth_deg.value, azimuth_deg, 0.12);
        EXPECT_NEAR(found.elevation_deg.value, elevation_deg, 0.15);
        EXPECT_NEAR(found.time_s.value, time_s, 12);
        EXPECT_THAT(untold(found), IsEmpty());
    }

    static inline Radar* b_ = nullptr;
    static inline Gridded* good_ = nullptr;
    static inline UtcTime instant_;
};

TEST_F(SiteComparisonTest, WithoutFaultsNoneIsNamed) {
    const SiteComparison found = compared(*b_);
    expect(found, 0, 0, 0, 0);
    EXPECT_THAT(faults(found), IsEmpty());
}

TEST_F(SiteComparisonTest, HalfADegreeOfAzimuthIsNamedAndNothingElse) {
    Radar b = *b_;
    turn_clockwise(b.volume, 0.5F);
    const SiteComparison found = compared(b);
    expect(found, 0, 0.5, 0, 0);
    EXPECT_THAT(faults(found), ElementsAre(HasSubstr("XSYB against XSYA: turned clockwise by 0.")));
}

TEST_F(SiteComparisonTest, HalfADegreeOfElevationIsNamedAndNothingElse) {
    Radar b = *b_;
    change_radials(b.volume, [](level2::Radial& radial) { radial.elevation_deg += 0.5F; });
    for (level2::Sweep& sweep : b.volume.sweeps) {
        if (sweep.vcp_elevation_deg) *sweep.vcp_elevation_deg += 0.5F;
    }
    for (level2::VcpCut& cut : b.volume.vcp_message->cuts)
        cut.elevation_deg += 0.5F;
    const SiteComparison found = compared(b);
    expect(found, 0, 0, 0.5, 0);
    EXPECT_THAT(faults(found), ElementsAre(HasSubstr("XSYB against XSYA: raised by 0.")));
}

TEST_F(SiteComparisonTest, TwoDecibelsAreNamedAndNothingElse) {
    Radar b = *b_;
    for (level2::Sweep& sweep : b.volume.sweeps) {
        for (level2::SweepMoment& moment : sweep.moments)
            moment.offset += 2 * moment.scale;
    }
    const SiteComparison found = compared(b);
    expect(found, -2, 0, 0, 0);
    EXPECT_THAT(faults(found), ElementsAre(HasSubstr("XSYB against XSYA: too weak by ")));
}

TEST_F(SiteComparisonTest, ThirtySecondsAreNamedAndNothingElse) {
    Radar b = *b_;
    change_radials(b.volume, [&](level2::Radial& radial) {
        radial.time -= std::chrono::seconds{seconds_of_fault};
    });
    const SiteComparison found = compared(b);
    expect(found, 0, 0, 0, seconds_of_fault);
    EXPECT_THAT(faults(found), ElementsAre(HasSubstr("XSYB against XSYA: clock late by ")));
}

TEST_F(SiteComparisonTest, WithoutAMotionThereIsNoTime) {
    const SiteComparison unknown = compared(*b_, std::nullopt);
    EXPECT_THAT(
        untold(unknown),
        ElementsAre("XSYB against XSYA: time cannot be determined: the motion is not known"));
    const SiteComparison still = compared(*b_, UniformMotion{0.5, 0.5});
    EXPECT_THAT(
        untold(still),
        ElementsAre("XSYB against XSYA: time cannot be determined: the weather stands still"));
}

// The second site sees the same echo five minutes later and 8 km farther, without a fault.
TEST_F(SiteComparisonTest, LooksMinutesApartWithoutAMotionTellNoAngles) {
    Radar b = *b_;
    change_radials(b.volume,
                   [&](level2::Radial& radial) { radial.time += std::chrono::minutes{5}; });
    const SiteComparison found = compared(b, std::nullopt);
    EXPECT_NE(found.azimuth_deg.untold, "");
    EXPECT_NE(found.elevation_deg.untold, "");
    EXPECT_NE(found.time_s.untold, "");
    EXPECT_THAT(faults(found), IsEmpty());
}

// Shows the second site other weather at the same places.
TEST_F(SiteComparisonTest, SitesThatHardlySeeTheSameTellNothing) {
    Radar b = *b_;
    turn_clockwise(b.volume, 40.0F);
    const SiteComparison found = compared(b);
    EXPECT_EQ(untold(found).size(), 4U);
    EXPECT_THAT(faults(found), IsEmpty());
}

TEST_F(SiteComparisonTest, WithoutEchoInCommonNothingIsTold) {
    Radar far = *b_;
    far.site.longitude_deg = -90;  // 690 km away
    GridSpec there = domain();
    there.center_longitude_deg = -90;
    const Gridded other = gridded(far, there, instant_);
    const auto found = compare_sites(good_->as_site(), other.as_site(), {});
    ASSERT_TRUE(found);
    EXPECT_EQ(untold(*found).size(), 4U);
    EXPECT_THAT(untold(*found)[0], HasSubstr("there is no echo where both sites look"));
    EXPECT_THAT(faults(*found), IsEmpty());

    ComparisonOptions strong;
    strong.least_dbz = 62;
    const Gridded near = gridded(*b_, domain(), instant_);
    const auto few = compare_sites(good_->as_site(), near.as_site(), strong);
    ASSERT_TRUE(few);
    EXPECT_THAT(untold(*few)[0], HasSubstr("too little echo in common"));
}

// Finds the same faults in a grid with its own projection, center and size of cells.
TEST_F(SiteComparisonTest, GridsNeedNotBeTheSame) {
    GridSpec spec = domain();
    spec.projection = Projection::lambert_conformal;
    spec.parallels_deg = {35, 35};
    spec.center_longitude_deg = -96.6;
    spec.center_latitude_deg = 35.1;
    spec.spacing_m = 1250;
    for (double& level_m : spec.levels_m)
        level_m += 100;
    const Gridded other = gridded(*b_, spec, instant_);
    ComparisonOptions options{.motion = motion};
    const auto found = compare_sites(good_->as_site(), other.as_site(), options);
    ASSERT_TRUE(found);
    print(*found);
    expect(*found, 0, 0, 0, 0);
    EXPECT_THAT(faults(*found), IsEmpty());
}

TEST_F(SiteComparisonTest, BadOptionsAreErrors) {
    ComparisonOptions options;
    options.greatest_range_m = 0;
    EXPECT_EQ(compare_sites(good_->as_site(), good_->as_site(), options).error().code,
              ErrorCode::bad_argument);
    options = {};
    options.motion = UniformMotion{NAN, 0};
    EXPECT_EQ(compare_sites(good_->as_site(), good_->as_site(), options).error().code,
              ErrorCode::bad_argument);
    const CellDetails none;
    SiteGrid other = good_->as_site();
    other.details = &none;
    EXPECT_EQ(compare_sites(good_->as_site(), other, {}).error().code, ErrorCode::bad_argument);
}

// A grid compared with itself has no differences.
TEST_F(SiteComparisonTest, AGridAgreesWithItself) {
    ComparisonOptions options{.motion = motion};
    const auto found = compare_sites(good_->as_site(), good_->as_site(), options);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->bias_db.value, 0, 1e-9);
    EXPECT_NEAR(found->azimuth_deg.value, 0, 1e-9);
    EXPECT_NEAR(found->elevation_deg.value, 0, 1e-9);
    EXPECT_NEAR(found->time_s.value, 0, 1e-9);
}

}  // namespace
}  // namespace stormcellar::grid
