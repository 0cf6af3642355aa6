// Tests, against limits in closed form, what each method does to a point, an edge and a wave
// (tests/grid/quality_chart.h). Gates are sampled at their centers. docs/accuracy.md has the whole
// table.
#include "tests/grid/quality_chart.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/grid/method_of.h"

namespace stormcellar::grid {
namespace {

constexpr double cell_km = 1;
constexpr double gate_km = 0.25;
// spacing of the lowest three cuts; higher cuts have one degree
constexpr double fine_deg = 0.5;
constexpr double coarse_deg = 1;

double radials_apart_km(double range_km, double apart_deg = coarse_deg) {
    return range_km * apart_deg * M_PI / 180;
}

const Method nearest = method_of(Interpolation::nearest, CellExtent::point, Averaging::in_z);
const Method linear = method_of(Interpolation::linear, CellExtent::point, Averaging::in_z);
const Method eight = method_of(Interpolation::eight_point, CellExtent::point, Averaging::in_z);
const Method by_beam = method_of(Interpolation::beam_weighted, CellExtent::point, Averaging::in_z);
const Method area = method_of(Interpolation::linear, CellExtent::area, Averaging::in_z);

class AtRange : public ::testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Kilometres, AtRange, ::testing::Values(50, 150));

// No method may move a point by more than a quarter of the largest of cell, gate and radial
// spacing.
TEST_P(AtRange, APointStaysWhereItIs) {
    const double range_km = GetParam();
    const Observed point = observe_point(range_km * 1000, Gates::of_points);
    const double largest_km = std::max({cell_km, gate_km, radials_apart_km(range_km)});
    for (const Method& method : {nearest, linear, eight, by_beam, area}) {
        const PointChart chart = point_chart(point, method);
        EXPECT_LT(chart.shift_km, largest_km / 4) << method.name();
        EXPECT_LE(chart.peak_dbz, 50.26) << method.name() << ": no method adds echo";
    }
}

// A gate, the distance between radials, and a cell are boxes that sampling treats as points. Each
// box of width s adds at most the variance s^2 / 12. Linear weights between boxes double their
// variance.
TEST_P(AtRange, APointIsNoWiderThanGateRadialAndCellMakeIt) {
    const double range_km = GetParam();
    const Observed point = observe_point(range_km * 1000, Gates::of_points);
    const double apart_km = radials_apart_km(range_km);
    const auto wider = [](double true_km, double boxes_km2) {
        return std::sqrt(true_km * true_km + 2.3548 * 2.3548 * boxes_km2 / 12);
    };
    for (const Method& method : {nearest, linear, eight, area}) {
        const PointChart chart = point_chart(point, method);
        const double times = method.interpolation == Interpolation::eight_point ? 2 : 1;
        const double cell_km2 = method.cell == CellExtent::area ? cell_km * cell_km : 0;
        EXPECT_LT(chart.along_km,
                  1.1 * wider(chart.true_along_km, times * gate_km * gate_km + cell_km2))
            << method.name();
        EXPECT_LT(chart.across_km,
                  1.1 * wider(chart.true_across_km, times * apart_km * apart_km + cell_km2))
            << method.name();
        EXPECT_GT(chart.across_km, 0.75 * chart.true_across_km) << method.name();
    }
}

TEST_P(AtRange, TheBeamsPatternSmearsAcrossTheBeam) {
    const Observed point = observe_point(GetParam() * 1000, Gates::of_points);
    EXPECT_GT(point_chart(point, by_beam).across_km, point_chart(point, linear).across_km);
}

// The mean in Z over all gates of a cell preserves the total. Sampling points preserves the total
// only on average, and the mean in dB always loses a part of it.
TEST(Conservation, TheMeanInZOverCellsKeepsTheTotal) {
    const Observed point = observe_point(50e3, Gates::of_points);
    const PointChart in_z = point_chart(point, area);
    EXPECT_NEAR(in_z.total_z_ratio, 1, 0.1);
    Method in_db = area;
    in_db.averaging = Averaging::in_db;
    EXPECT_LT(point_chart(point, in_db).total_z_ratio, in_z.total_z_ratio - 0.05);
}

// An edge must be at least as steep as the widest box of the average, and not shift by more than
// half that box.
TEST_P(AtRange, AnEdgeAlongTheBeamStaysAsSteepAsGatesAndCells) {
    const Observed edge = observe_edge(GetParam() * 1000, Gates::of_points);
    for (const Method& method : {nearest, linear, eight, by_beam}) {
        const EdgeChart chart = edge_chart(edge, method);
        EXPECT_LT(chart.rise_km, 2 * gate_km + 0.25) << method.name();
        EXPECT_LT(std::abs(chart.shift_km), gate_km / 2 + 0.13) << method.name();
    }
    // A box as wide as a cell, seen at 40 degrees, is at most 1.41 km from corner to corner.
    const EdgeChart chart = edge_chart(edge, area);
    EXPECT_GT(chart.rise_km, 0.4);
    EXPECT_LT(chart.rise_km, 1.6);
}

// The nearest radial acts as a box as wide as the distance between radials. The mean over a box of
// width w leaves sin(pi w / length) / (pi w / length) of a wave.
TEST_P(AtRange, AWaveKeepsWhatAMeanOverABoxLeaves) {
    const double range_km = GetParam();
    const Observed wave = observe_wave(range_km * 1000, Gates::of_points, 8000, true);
    const auto left = [](double box_km) {
        const double x = M_PI * box_km / 8;
        return std::sin(x) / x;
    };
    const double most = left(radials_apart_km(range_km, fine_deg));
    const double least = left(radials_apart_km(range_km, coarse_deg));
    const auto kept = [&](const Method& method) {
        return wave_chart(wave, method).amplitude_ratio;
    };
    for (const Interpolation one : {Interpolation::nearest, Interpolation::linear}) {
        const Method method = method_of(one, CellExtent::point, Averaging::in_db);
        EXPECT_LT(kept(method), most + 0.03) << method.name();
        EXPECT_GT(kept(method), least - 0.03) << method.name();
    }
    const Method eight_db =
        method_of(Interpolation::eight_point, CellExtent::point, Averaging::in_db);
    EXPECT_LT(kept(eight_db), most * most + 0.03);
    EXPECT_GT(kept(eight_db), least * least - 0.03);
    EXPECT_LT(kept(by_beam), kept(nearest));
    for (const Method& method : {nearest, linear, eight, by_beam, area})
        EXPECT_LT(std::abs(wave_chart(wave, method).shift_km), 0.25) << method.name();
}

}  // namespace
}  // namespace stormcellar::grid
