#include "grid/plan/position_error.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/grid/square_spec.h"
#include "tests/grid/volume_maker.h"

namespace stormcellar::grid {
namespace {

const SitePosition site{"KTLX", 35, -97, 390};

GridSpec small_spec() {
    return square_spec(site.latitude_deg, site.longitude_deg, 101);
}

// Returns two sweeps at one elevation. One radial of the first sweep is 0.3 degrees off.
level2::Volume unsteady_then_steady() {
    SweepPlan plan;
    auto volume = make_volume({plan, plan});
    volume.sweeps[0].radials[180].elevation_deg += 0.3F;
    for (level2::Radial& radial : volume.sweeps[1].radials)
        radial.time += std::chrono::minutes(3);
    return volume;
}

double jitter_m(const GridderOptions& options) {
    const auto volume = unsteady_then_steady();
    const GridSpec spec = small_spec();
    const auto chosen = sweeps_to_grid(volume, site, options);
    const RefractivityProfile profile = RefractivityProfile::reference();
    return effect_position_m({volume, site, spec, chosen, profile, options.moment},
                             "antenna_jitter");
}

TEST(PositionError, OfAnUnsteadyAntennaIsTheAngleTimesTheRange) {
    GridderOptions first;
    first.repeats = GridderOptions::Repeats::nearest_in_time;
    const double corner_m = 50e3 * std::numbers::sqrt2;
    EXPECT_NEAR(jitter_m(first), 0.3 * std::numbers::pi / 180 * corner_m, 2);
    EXPECT_EQ(jitter_m(GridderOptions{}), 0) << "the newest sweep was steady";
}

TEST(PositionError, WithoutAPlanIsThatOfTheSweepsThatAreGridded) {
    const auto volume = unsteady_then_steady();
    const GridSpec spec = small_spec();
    GridderOptions options;
    options.method.radial_elevations = false;
    const std::string newest = unplanned_error(volume, site, spec, FrameKind::table, options);
    options.repeats = GridderOptions::Repeats::nearest_in_time;
    const std::string first = unplanned_error(volume, site, spec, FrameKind::table, options);
    EXPECT_NE(first, newest);
    const auto metres = [](const std::string& text) {
        return std::stod(text.substr(std::string{"position "}.size()));
    };
    EXPECT_NEAR(metres(first) - metres(newest), jitter_m(options), 2) << first << "; " << newest;
}

}  // namespace
}  // namespace stormcellar::grid
