// Tests the liquid of columns against closed forms, and that unseen air counts as stated.
#include "stormcellar/retrieve/vertical_liquid.h"

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

namespace stormcellar::retrieve {
namespace {

using grid::CellStatus;

constexpr double step_m = 500;

// A column of levels 500 m apart, the lowest at 500 m.
struct SampledColumn {
    std::vector<double> levels_m;
    std::vector<float> dbz;
    std::vector<CellStatus> status;

    explicit SampledColumn(std::size_t count)
        : levels_m(count), dbz(count, 0), status(count, CellStatus::no_echo) {
        for (std::size_t i = 0; i < count; ++i)
            levels_m[i] = step_m * static_cast<double>(i + 1);
    }
    void set(std::size_t level, double value_dbz) {
        dbz[level] = static_cast<float>(value_dbz);
        status[level] = CellStatus::value;
    }
    [[nodiscard]] double liquid(std::optional<double> radar_m) const {
        return vertical_liquid_kg_per_m2(
            {levels_m, levels_m.front() - step_m / 2, levels_m.back() + step_m / 2, radar_m}, dbz,
            status);
    }
};

double liquid_of(double dbz, double thickness_m) {
    return 3.44e-6 * std::pow(10, dbz / 10 * 4 / 7) * thickness_m;
}

SampledColumn even_column(double dbz) {
    SampledColumn column(20);
    for (std::size_t i = 0; i < 20; ++i)
        column.set(i, dbz);
    return column;
}

// Integrates a profile (dBZ by height in m) in steps of 1 m.
double finely(const std::function<double(double)>& dbz_at, double from_m, double to_m) {
    double sum = 0;
    for (double h = from_m + 0.5; h < to_m; h += 1)
        sum += liquid_of(dbz_at(h), 1);
    return sum;
}

TEST(VerticalLiquid, OfAnEvenColumnIsItsClosedForm) {
    const double whole = liquid_of(45, 10'000);
    EXPECT_NEAR(even_column(45).liquid({}), whole, 1e-6 * whole);
    EXPECT_NEAR(even_column(45).liquid(0), whole, 1e-6 * whole) << "the grid begins at 250 m";
    EXPECT_NEAR(even_column(45).liquid(400), liquid_of(45, 9850), 1e-6 * whole);
    EXPECT_EQ(even_column(70).liquid({}), even_column(56).liquid({})) << "capped, for hail";
}

TEST(VerticalLiquid, OfSmoothProfilesIsTheIntegral) {
    const auto ramp = [](double h) { return 50 - 0.003 * h; };
    const auto parabola = [](double h) { return 55 - 45 * std::pow((h - 5000) / 9000, 2); };
    for (const auto& [profile, most] :
         {std::pair<std::function<double(double)>, double>{ramp, 0.005}, {parabola, 0.005}}) {
        SampledColumn column(20);
        for (std::size_t i = 0; i < 20; ++i)
            column.set(i, profile(column.levels_m[i]));
        const double whole = finely(profile, 250, 10'250);
        EXPECT_NEAR(column.liquid({}), whole, most * whole);
    }
}

TEST(VerticalLiquid, BelowTheLowestBeamIsThatOfTheLowestSeenCell) {
    SampledColumn column(20);
    for (std::size_t i = 0; i < 4; ++i)
        column.status[i] = CellStatus::not_seen;  // up to 2250 m
    column.set(4, 40);
    const double above = liquid_of(40 + 10 * std::log10(0.5), step_m);  // the mean with no echo
    EXPECT_NEAR(column.liquid(300), above + liquid_of(40, 2200), 1e-6);
    EXPECT_NEAR(column.liquid(-50), above + liquid_of(40, 2250), 1e-6) << "to the grid's bottom";
    EXPECT_NEAR(column.liquid(2400), above + liquid_of(40, 100), 1e-6);
    EXPECT_NEAR(column.liquid(9000), above, 1e-6) << "the radar is above the cell";
    EXPECT_NEAR(column.liquid({}), above + liquid_of(40, 250), 1e-6) << "half a layer";
    // If the lowest seen cell has no echo, nothing is assumed below it.
    column.status[3] = CellStatus::no_echo;
    EXPECT_NEAR(column.liquid(300), 2 * above, 1e-6);
}

TEST(VerticalLiquid, UnseenAirAboveAndBetweenAddsNothing) {
    SampledColumn column(20);
    for (CellStatus& status : column.status)
        status = CellStatus::not_seen;
    EXPECT_EQ(column.liquid(0), 0);
    column.set(0, 40);
    EXPECT_NEAR(column.liquid(250), liquid_of(40, 500), 1e-6);
    column.set(2, 40);
    EXPECT_NEAR(column.liquid(250), liquid_of(40, 1000), 1e-6);
    column.status[1] = CellStatus::range_folded;
    EXPECT_NEAR(column.liquid(250), liquid_of(40, 1000), 1e-6);
    column.set(19, 40);
    EXPECT_NEAR(column.liquid(250), liquid_of(40, 1500), 1e-6) << "up to the edge of the grid";
    column.dbz[5] = std::numeric_limits<float>::quiet_NaN();  // of a cell that was not seen
    EXPECT_NEAR(column.liquid(250), liquid_of(40, 1500), 1e-6);
}

TEST(VerticalLiquid, OfASingleLevelIsThatOfItsLayer) {
    SampledColumn column(1);
    column.set(0, 30);
    EXPECT_NEAR(column.liquid({}), liquid_of(30, step_m), 1e-9);
}

TEST(VerticalLiquid, TakesTheMeanHeightOfTheRadars) {
    EXPECT_FALSE(mean_radar_height_m({}));
    const std::array<grid::SitePosition, 2> sites = {
        {{"KTLX", 35, -97, 400}, {"KFDR", 34, -99, 300}}};
    EXPECT_EQ(mean_radar_height_m(sites), 350);
}

}  // namespace
}  // namespace stormcellar::retrieve
