// Tests that one SweepTime for each sweep suffices to find the time of a cell.
#include "grid/sweep/sweep_clock.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "stormcellar/grid/column_geometry.h"
#include "stormcellar/grid/gridder.h"
#include "tests/grid/real_volume.h"
#include "tests/grid/square_spec.h"
#include "tests/grid/volume_maker.h"

namespace stormcellar::grid {
namespace {

// as in grid/sweep/sweep_clock.h, at the 95th percentile of cells
constexpr double accuracy_s = 2;
constexpr double accuracy_of_step = 0.06;

double longest_step_s(const std::vector<SweepTime>& sweeps) {
    double longest = 0;
    for (std::size_t at = 1; at < sweeps.size(); ++at) {
        const auto step = sweeps[at].start - sweeps[at - 1].start;
        longest = std::max(longest, std::abs(std::chrono::duration<double>(step).count()));
    }
    return longest;
}

class RealClock : public ::testing::TestWithParam<const char*> {};

TEST_P(RealClock, IsThatOfTheGates) {
    STORMCELLAR_NEED_DATA();
    const level2::Volume volume = real_volume(GetParam());
    const SitePosition site = site_of(volume);
    GridSpec spec = square_spec(site.latitude_deg, site.longitude_deg, 115, 4000);
    const auto geometry = make_column_geometry(site, spec);
    ASSERT_TRUE(geometry);
    GridderOptions options;
    options.details.add(Detail::age);
    const auto grid = make_grid(volume, site, **geometry, options);
    ASSERT_TRUE(grid);
    const auto sweeps = sweep_times(volume, sweeps_to_grid(volume, site, options));
    const SweepClock clock(sweeps, BeamGeometry(site.latitude_deg, site.altitude_m),
                           *volume.start_time());

    std::vector<float> seconds(spec.levels_m.size());
    std::vector<double> errors;
    for (int iy = 0; iy < spec.ny; ++iy) {
        for (int ix = 0; ix < spec.nx; ++ix) {
            const ColumnPlace& place = (*geometry)->row(iy)[static_cast<std::size_t>(ix)];
            clock.read(static_cast<double>(place.azimuth_deg), static_cast<double>(place.arc_m),
                       spec.levels_m, seconds);
            for (int iz = 0; iz < spec.nz(); ++iz) {
                const auto age = grid->details.at(Detail::age, spec.index(ix, iy, iz));
                if (!age) continue;
                const float time = seconds[static_cast<std::size_t>(iz)];
                EXPECT_GE(static_cast<double>(time), clock.earliest_s() - 1e-3);
                EXPECT_LE(static_cast<double>(time), clock.latest_s() + 1e-3);
                errors.push_back(std::abs(static_cast<double>(time - *age)));
            }
        }
    }
    ASSERT_GT(errors.size(), 20'000U);
    const auto p95 = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() * 95 / 100);
    std::nth_element(errors.begin(), p95, errors.end());
    EXPECT_LT(*p95, std::max(accuracy_s, accuracy_of_step * longest_step_s(sweeps)));
}
INSTANTIATE_TEST_SUITE_P(Volumes, RealClock,
                         ::testing::Values("volumes/KTLX19990503_235621.gz",
                                           "volumes/KLOT20220317_000842_V06",
                                           "volumes/KDMX20250101_225441_V06",
                                           "mosaic-northeast/KOKX20100911_011047_V03.gz"));

TEST(SweepTimes, AreThoseOfTheRadials) {
    // The sweeps begin 20 s apart, and a radial of one degree takes 50 ms
    // (tests/grid/volume_maker.h).
    const level2::Volume volume =
        make_volume({{.elevation_deg = 0.5, .cut = 1},
                     {.elevation_deg = 2.4, .cut = 2, .first_azimuth_deg = 180.5}});
    const auto times = sweep_times(volume, choose_sweeps(volume, level2::Moment::ref, 0.475));
    ASSERT_EQ(times.size(), 2U);
    EXPECT_EQ(times[0].first_azimuth_deg, 0.5);
    EXPECT_EQ(times[1].first_azimuth_deg, 180.5);
    EXPECT_NEAR(times[0].degrees_per_s, 20, 1e-9);
    EXPECT_EQ(times[1].start - times[0].start, std::chrono::seconds{20});

    const SweepClock clock(times, BeamGeometry(35, 300), times[0].start);
    const std::array<double, 4> levels = {400, 1000, 2000, 9000};
    std::array<float, 4> seconds{};
    const double arc_m = 50'000, azimuth_deg = 90.5;
    clock.read(azimuth_deg, arc_m, levels, seconds);
    const BeamGeometry beam(35, 300);
    const double low_m = beam.over(arc_m, 0.5).height_m, high_m = beam.over(arc_m, 2.4).height_m;
    const double low_s = 4.5, high_s = 20 + 13.5;  // 90 and 270 degrees at 20 degrees per second
    EXPECT_NEAR(seconds[0], low_s, 1e-4);
    for (const std::size_t level : {1U, 2U}) {
        const double share = (levels[level] - low_m) / (high_m - low_m);
        EXPECT_NEAR(seconds[level], low_s + share * (high_s - low_s), 1e-4);
    }
    EXPECT_NEAR(seconds[3], high_s, 1e-4);
}

// Regression of 2026-11-28: half the sweeps of a volume had the date of another year, so echo moved
// very far, and reading the columns on its way took 8.7 GB.
TEST(SweepTimes, OfAnotherDayAreNone) {
    level2::Volume volume =
        make_volume({{.elevation_deg = 0.5, .cut = 1}, {.elevation_deg = 2.4, .cut = 2}});
    const auto chosen = choose_sweeps(volume, level2::Moment::ref, 0.475);
    ASSERT_EQ(sweep_times(volume, chosen).size(), 2U);
    volume.sweeps[0].radials.back().time += std::chrono::days{365};
    const auto but_one = sweep_times(volume, chosen);
    ASSERT_EQ(but_one.size(), 2U);
    EXPECT_NEAR(but_one[0].degrees_per_s, 20, 1);
    for (level2::Radial& radial : volume.sweeps[1].radials)
        radial.time += std::chrono::days{365};
    EXPECT_EQ(sweep_times(volume, chosen).size(), 1U);

    const BeamGeometry beam(35, 300);
    const UtcTime start = but_one[0].start, middle = start + std::chrono::minutes{2};
    EXPECT_TRUE(SweepClock::of_volume(but_one, beam, start, middle));
    EXPECT_FALSE(SweepClock::of_volume({}, beam, start, middle));
    auto late = but_one, slow = but_one;
    late[1].start += std::chrono::hours{2};
    slow[1].degrees_per_s = 1e-9;
    EXPECT_FALSE(SweepClock::of_volume(late, beam, start, middle));
    EXPECT_FALSE(SweepClock::of_volume(slow, beam, start, middle));
}

TEST(SweepTimes, OfASweepOfOneRadialOrOfNoDateAreNotInvented) {
    level2::Volume volume = make_volume(
        {{.elevation_deg = 0.5, .cut = 1, .radials = 1}, {.elevation_deg = 2.4, .cut = 2}});
    for (level2::Radial& radial : volume.sweeps[1].radials)
        radial.time = UtcTime{} - std::chrono::days{2};
    std::vector<ChosenSweep> chosen(2);
    chosen[0].radials = {0};
    chosen[1].sweep_index = 1;
    chosen[1].radials = {0, 1, 2};
    const auto times = sweep_times(volume, chosen);
    ASSERT_EQ(times.size(), 1U);
    EXPECT_EQ(times[0].degrees_per_s, 0);
}

}  // namespace
}  // namespace stormcellar::grid
