#include "accuracy/plot_layout.h"

#include <random>

#include <gtest/gtest.h>

namespace stormcellar::accuracy {
namespace {

PlotLayout laid_out(const Plot& plot) {
    auto layout = lay_out_plot(plot);
    EXPECT_TRUE(layout);
    return layout.value_or(PlotLayout{});
}

Plot plot_of(std::vector<PlotPoint> points) {
    Plot plot;
    plot.points = std::move(points);
    return plot;
}

TEST(PlotLayout, AxesAreLogarithmicUpwardsAndToTheRight) {
    const PlotLayout layout = laid_out(plot_of(
        {{"a", "s", 0.001, 10, true}, {"b", "s", 0.01, 1, true}, {"c", "s", 0.1, 0.1, true}}));
    ASSERT_EQ(layout.markers.size(), 3U);
    EXPECT_NEAR(layout.markers[1].x - layout.markers[0].x,
                layout.markers[2].x - layout.markers[1].x, 1e-9);
    EXPECT_NEAR(layout.markers[1].y - layout.markers[0].y,
                layout.markers[2].y - layout.markers[1].y, 1e-9);
    EXPECT_GT(layout.markers[1].x, layout.markers[0].x);
    EXPECT_GT(layout.markers[1].y, layout.markers[0].y);  // a smaller error is drawn lower
    EXPECT_FALSE(layout.zero_y);
}

TEST(PlotLayout, ExactPointsStandInARowBelowTheAxis) {
    const PlotLayout layout =
        laid_out(plot_of({{"a", "s", 0.001, 10, true}, {"exact", "s", 1, 0, true}}));
    ASSERT_TRUE(layout.zero_y);
    EXPECT_EQ(layout.markers[1].y, *layout.zero_y);
    for (const PlotTick& tick : layout.error_ticks)
        EXPECT_LT(tick.position, *layout.zero_y - 10);
}

TEST(PlotLayout, ErrorsOfRoundingDoNotSqueezeTheRest) {
    const PlotLayout layout = laid_out(plot_of({{"a", "s", 0.001, 10, true},
                                                {"least shown", "s", 0.1, 1.1e-3, true},
                                                {"rounding", "s", 1, 9e-4, true}}));
    ASSERT_TRUE(layout.zero_y);
    EXPECT_DOUBLE_EQ(layout.zero_below, 1e-3);
    EXPECT_EQ(layout.markers[2].y, *layout.zero_y);
    EXPECT_LT(layout.markers[1].y, *layout.zero_y - 10);
    EXPECT_EQ(laid_out(plot_of({{"a", "s", 0.001, 10, true}, {"b", "s", 1, 0, true}})).zero_below,
              0);
}

TEST(PlotLayout, TicksLieInsideApartAndWhereTheySay) {
    std::mt19937_64 random(20261121);
    for (int trial = 0; trial < 300; ++trial) {
        std::uniform_real_distribution<double> exponent(-9, 6);
        const double low = exponent(random);
        std::uniform_real_distribution<double> within(low, std::max(low + 0.01, exponent(random)));
        std::vector<PlotPoint> points;
        for (int i = 0; i < 6; ++i) {
            points.push_back(
                {"p", "s", std::pow(10, within(random)), std::pow(10, within(random)), false});
        }
        const PlotLayout layout = laid_out(plot_of(points));
        for (const auto* ticks : {&layout.time_ticks, &layout.error_ticks}) {
            const bool is_time = ticks == &layout.time_ticks;
            EXPECT_GE(ticks->size(), 2U);
            for (std::size_t i = 0; i < ticks->size(); ++i) {
                const double position = (*ticks)[i].position;
                EXPECT_GE(position, is_time ? layout.frame.left : layout.frame.top);
                EXPECT_LE(position, is_time ? layout.frame.right : layout.frame.bottom);
                if (i > 0) {
                    EXPECT_GT(std::abs(position - (*ticks)[i - 1].position), 15);
                }
            }
        }
        for (const PlotMarker& marker : layout.markers) {
            EXPECT_GE(marker.x, layout.frame.left + marker_radius);
            EXPECT_LE(marker.x, layout.frame.right - marker_radius);
            EXPECT_GE(marker.y, layout.frame.top + marker_radius);
            EXPECT_LE(marker.y, layout.frame.bottom - marker_radius);
        }
    }
}

// Returns a plot of 25 points of five steps. Some points are nearly equal.
Plot crowded() {
    std::mt19937_64 random(3);
    Plot plot;
    const char* const steps[] = {"frame", "beam", "interpolation", "averaging", "time"};
    for (int i = 0; i < 25; ++i) {
        std::uniform_real_distribution<double> exponent(-3, 0.5);
        plot.points.push_back({"rung number " + std::to_string(i), steps[i % 5],
                               std::pow(10, exponent(random)),
                               i % 5 == 4 ? 0 : std::pow(10, exponent(random)), i % 3 == 0});
    }
    return plot;
}

TEST(PlotLayout, LabelsHideNeitherEachOtherNorPoints) {
    const PlotLayout layout = laid_out(crowded());
    ASSERT_EQ(layout.labels.size(), 25U);
    for (std::size_t i = 0; i < layout.labels.size(); ++i) {
        const PlotBox& box = layout.labels[i].box;
        EXPECT_EQ(layout.labels[i].marker, i);
        EXPECT_GE(box.left, layout.frame.left);
        EXPECT_GE(box.top, layout.frame.top);
        EXPECT_LE(box.bottom, layout.frame.bottom);
        for (std::size_t k = 0; k < i; ++k)
            EXPECT_EQ(box.overlap(layout.labels[k].box), 0) << i;
        for (const PlotMarker& marker : layout.markers) {
            const PlotBox dot = {marker.x - marker_radius, marker.y - marker_radius,
                                 marker.x + marker_radius, marker.y + marker_radius};
            EXPECT_EQ(box.overlap(dot), 0) << i;
        }
    }
}

TEST(PlotLayout, SeriesKeepTheOrderOfTheirFirstPoints) {
    const PlotLayout layout = laid_out(plot_of(
        {{"a", "frame", 1, 1, true}, {"b", "beam", 1, 2, true}, {"c", "frame", 1, 3, true}}));
    EXPECT_EQ(layout.series, (std::vector<std::string>{"frame", "beam"}));
    EXPECT_EQ(layout.markers[2].series, 0U);
}

TEST(PlotLayout, OnePointOrOnlyExactOnesHaveAPlot) {
    EXPECT_GE(laid_out(plot_of({{"a", "s", 3e-7, 5e8, true}})).time_ticks.size(), 2U);
    const PlotLayout exact = laid_out(plot_of({{"a", "s", 1, 0, true}, {"b", "s", 2, 0, false}}));
    EXPECT_TRUE(exact.error_ticks.empty());
    EXPECT_TRUE(exact.zero_y);
}

}  // namespace
}  // namespace stormcellar::accuracy
