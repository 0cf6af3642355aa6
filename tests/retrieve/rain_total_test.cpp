// Compares rain totals of moving storms with their integral in closed form, and counts the minutes
// that were not seen.
#include "stormcellar/retrieve/rain_total.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

namespace stormcellar::retrieve {
namespace {

using grid::CellStatus;

constexpr UtcTime total_start{std::chrono::sys_days{std::chrono::year{2024} / 6 / 1}};
constexpr double storm_km = 3, storm_mm_per_h = 60, moving_storm_mps = 30, apart_s = 300,
                 hour_s = 3600;
// Storms begin here and move to the east.
constexpr std::array<std::array<double, 2>, 6> storms_km = {
    {{-95, -50}, {-80, -31}, {-90, -10}, {-75, 11}, {-88, 30}, {-70, 50}}};

grid::GridSpec total_spec() {
    grid::GridSpec spec = grid::default_spec(35, -97);
    spec.nx = 220;
    spec.ny = 140;
    spec.spacing_m = 1000;
    spec.levels_m = {1000, 2000};
    return spec;
}

// Returns the rain rates at a time. The lower level is seen only within 40 km.
grid::BrickGrid storms_at(double t_s, double seen_km = 1e9) {
    grid::Grid rates;
    rates.spec = total_spec();
    rates.moment = level2::Moment::rate;
    rates.values.resize(rates.spec.cell_count());
    rates.status.resize(rates.spec.cell_count());
    for (int iy = 0; iy < rates.spec.ny; ++iy)
        for (int ix = 0; ix < rates.spec.nx; ++ix) {
            const double x = rates.spec.x_m(ix) / 1000, y = rates.spec.y_m(iy) / 1000;
            double rate = 0;
            for (const auto& [x_km, y_km] : storms_km) {
                const double dx = x - x_km - moving_storm_mps * t_s / 1000, dy = y - y_km;
                rate += storm_mm_per_h * std::exp(-(dx * dx + dy * dy) / (2 * storm_km * storm_km));
            }
            for (int iz = 0; iz < 2; ++iz) {
                const double km = std::hypot(x, y);
                if (km > seen_km || (iz == 0 && km > 40)) continue;
                const std::size_t cell = rates.spec.index(ix, iy, iz);
                rates.status[cell] = rate < 0.03 ? CellStatus::no_echo : CellStatus::value;
                rates.values[cell] = rate < 0.03 ? 0 : static_cast<float>(rate);
            }
        }
    return grid::BrickGrid::from(rates, grid::default_quantization(level2::Moment::rate));
}

// Integrates the rates at a place over the hour.
double true_mm(double x_km, double y_km) {
    double mm = 0;
    for (const auto& [storm_x, storm_y] : storms_km) {
        const double width = storm_km * std::numbers::sqrt2;
        const double begin = (x_km - storm_x) / width;
        const double end = (x_km - storm_x - moving_storm_mps * hour_s / 1000) / width;
        const double dy = (y_km - storm_y) / width;
        mm += storm_mm_per_h * std::exp(-dy * dy) * (std::erf(begin) - std::erf(end)) * width *
              std::sqrt(std::numbers::pi) / 2 / (moving_storm_mps * hour_s / 1000);
    }
    return mm;
}

UtcTime total_time(double seconds) {
    return total_start + std::chrono::milliseconds{std::llround(1000 * seconds)};
}

RainTotal hour_of_storms(RainSteps steps) {
    RainTotal total({"KTLX", 35, -97, 300}, steps);
    for (double t_s = 0; t_s <= hour_s; t_s += apart_s) {
        const grid::BrickGrid rates = storms_at(t_s);
        const Status added = total.add(rates.view(), total_time(t_s));
        EXPECT_TRUE(added) << added.error().message;
    }
    return total;
}

// Returns the largest error of any column, as a share of the largest total.
double largest_error(const RainTotal& total) {
    const grid::GridSpec& spec = total.spec();
    double error = 0, largest = 0;
    for (int iy = 0; iy < spec.ny; ++iy)
        for (int ix = 0; ix < spec.nx; ++ix) {
            const double mm = true_mm(spec.x_m(ix) / 1000, spec.y_m(iy) / 1000);
            largest = std::max(largest, mm);
            error = std::max(error,
                             std::abs(mm - static_cast<double>(total.mm()[spec.index(ix, iy, 0)])));
        }
    return error / largest;
}

TEST(RainTotal, OfMovingStormsIsTheirIntegralAndNoComb) {
    const double advected = largest_error(hour_of_storms(RainSteps::advected));
    const double in_place = largest_error(hour_of_storms(RainSteps::in_place));
    ::testing::Test::RecordProperty("advected", std::to_string(advected));
    ::testing::Test::RecordProperty("in place", std::to_string(in_place));
    std::printf("largest error: advected %.4f, in place %.4f\n", advected, in_place);
    EXPECT_LE(advected, 0.01);
    EXPECT_GE(in_place, 0.3) << "without motion, the total is a comb";
}

// The volumes do not begin or end with the hour.
TEST(RainTotal, OfAnHourWithinTheVolumesIsItsIntegral) {
    RainTotal total({"KTLX", 35, -97, 300}, RainSteps::advected, 1,
                    RainSpan{total_time(0), total_time(hour_s)});
    for (double t_s = -450; t_s <= hour_s + 450; t_s += apart_s)
        ASSERT_TRUE(total.add(storms_at(t_s).view(), total_time(t_s)));
    total.close();
    EXPECT_NEAR(total.minutes(), 60, 1e-9);
    EXPECT_EQ(total.gap_minutes(), 0);
    const double error = largest_error(total);
    std::printf("largest error of an hour within the volumes: %.4f\n", error);
    EXPECT_LE(error, 0.01);
}

TEST(RainTotal, CountsTheMinutesOfASpanThatHaveNoVolumes) {
    for (const RainSteps steps : {RainSteps::advected, RainSteps::in_place}) {
        RainTotal total({"KTLX", 35, -97, 300}, steps, 1,
                        RainSpan{total_time(-3600), total_time(3600)});
        for (const double t_s : {-600.0, -300.0, 0.0, 300.0, 3300.0, 3900.0})
            ASSERT_TRUE(total.add(storms_at(t_s).view(), total_time(t_s)));
        total.close();
        EXPECT_NEAR(total.minutes(), 120, 1e-9);
        EXPECT_NEAR(total.gap_minutes(), 50 + 50, 1e-9) << "before the first, and a gap";
        EXPECT_NEAR(total.unseen_minutes()[total.spec().index(110, 70, 0)], 100, 0.01);
    }
}

TEST(RainTotal, ASpanAfterTheVolumesIsNotSeen) {
    RainTotal total({"KTLX", 35, -97, 300}, RainSteps::advected, 1,
                    RainSpan{total_time(7200), total_time(10800)});
    for (const double t_s : {0.0, 300.0})
        ASSERT_TRUE(total.add(storms_at(t_s).view(), total_time(t_s)));
    total.close();
    EXPECT_NEAR(total.minutes(), 60, 1e-9);
    EXPECT_NEAR(total.gap_minutes(), 60, 1e-9);
    EXPECT_EQ(*std::ranges::max_element(total.mm()), 0);
    RainTotal none({"KTLX", 35, -97, 300}, RainSteps::advected, 1,
                   RainSpan{total_time(0), total_time(10)});
    none.close();
    EXPECT_EQ(none.minutes(), 0) << "without a volume nothing is known";
}

TEST(RainTotal, LowestCellsOfReflectivityGiveTheRateByReflectivity) {
    grid::Grid echo;
    echo.spec = total_spec();
    echo.values.assign(echo.spec.cell_count(), 0);
    echo.status.assign(echo.spec.cell_count(), CellStatus::not_seen);
    const auto put = [&](int ix, int iz, CellStatus status, float dbz) {
        echo.status[echo.spec.index(ix, 9, iz)] = status;
        echo.values[echo.spec.index(ix, 9, iz)] = dbz;
    };
    put(1, 0, CellStatus::value, 40);
    put(1, 1, CellStatus::value, 60);
    put(2, 1, CellStatus::value, 60);
    put(3, 0, CellStatus::no_echo, 0);
    put(4, 0, CellStatus::range_folded, 0);
    const grid::BrickGrid bricks =
        grid::BrickGrid::from(echo, grid::default_quantization(level2::Moment::ref));
    const grid::Grid rates =
        grid::to_dense(lowest_rates(bricks.view(), level2::Moment::ref, 1).view());
    ASSERT_EQ(rates.spec.nz(), 1);
    const auto at = [&](int ix) { return rates.spec.index(ix, 9, 0); };
    EXPECT_NEAR(rates.values[at(1)], 12.24, 0.01) << "(10^4 / 300)^(1 / 1.4)";
    EXPECT_NEAR(rates.values[at(2)], 103.8, 0.1) << "capped at 53 dBZ";
    EXPECT_EQ(rates.status[at(3)], CellStatus::no_echo);
    EXPECT_EQ(rates.status[at(4)], CellStatus::not_seen);
    EXPECT_EQ(rates.status[at(5)], CellStatus::not_seen);
}

TEST(RainTotal, CountsMinutesThatWereNotSeen) {
    RainTotal total({"KTLX", 35, -97, 300});
    EXPECT_TRUE(total.mm().empty());
    ASSERT_TRUE(total.add(storms_at(0, 60).view(), total_time(0)));
    ASSERT_TRUE(total.add(storms_at(300, 60).view(), total_time(300)));
    ASSERT_TRUE(total.add(storms_at(2400, 60).view(), total_time(2400)));
    EXPECT_NEAR(total.minutes(), 40, 1e-9);
    const grid::GridSpec& spec = total.spec();
    EXPECT_EQ(spec.nz(), 1);
    EXPECT_NEAR(total.unseen_minutes()[spec.index(110, 70, 0)], 35, 0.01) << "no bridge";
    EXPECT_NEAR(total.unseen_minutes()[spec.index(2, 2, 0)], 40, 0.01) << "beyond what is seen";
}

TEST(RainTotal, RefusesVolumesThatDoNotFit) {
    RainTotal total({"KTLX", 35, -97, 300});
    ASSERT_TRUE(total.add(storms_at(0).view(), total_time(300)));
    EXPECT_EQ(total.add(storms_at(0).view(), total_time(300)).error().code,
              ErrorCode::bad_argument);
    grid::GridSpec other = total_spec();
    other.nx = 20;
    const grid::BrickGrid small(other, grid::default_quantization(level2::Moment::rate));
    EXPECT_EQ(total.add(small.view(), total_time(600)).error().code, ErrorCode::bad_argument);
}

}  // namespace
}  // namespace stormcellar::retrieve
