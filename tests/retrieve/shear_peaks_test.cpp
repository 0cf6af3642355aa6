// Tests the strongest azimuthal shear of grids against a slow search of all columns, and by hand.
#include "stormcellar/retrieve/shear_peaks.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "stormcellar/grid/brick_grid.h"

namespace stormcellar::retrieve {
namespace {

using grid::CellStatus;

constexpr float half_code_per_s = 0.5F * 0.03125e-3F;

grid::Grid no_shear() {
    grid::Grid made;
    made.moment = level2::Moment::azsh;
    made.spec.center_latitude_deg = 35;
    made.spec.center_longitude_deg = -97;
    made.spec.nx = 50;
    made.spec.ny = 37;
    for (int level = 0; level < 20; ++level)
        made.spec.levels_m.push_back(500.0 + 500.0 * level);
    made.values.assign(made.spec.cell_count(), 0.0F);
    made.status.assign(made.spec.cell_count(), CellStatus::no_echo);
    return made;
}

void set_shear(grid::Grid& made, int ix, int iy, int level, float per_s) {
    const std::size_t at = made.spec.index(ix, iy, level);
    made.values[at] = 1000 * per_s;
    made.status[at] = CellStatus::value;
}

std::vector<ShearPeak> peaks_of_grid(const grid::Grid& made, const ShearPeakOptions& options = {}) {
    const auto bricks = grid::BrickGrid::from(made, grid::default_quantization(made.moment));
    return shear_peaks(bricks.view(), options);
}

TEST(ShearPeaks, AreTheStrongestColumnsOfTheLayer) {
    grid::Grid made = no_shear();
    set_shear(made, 10, 20, 2, 0.0123F);
    set_shear(made, 10, 20, 3, 0.008F);
    set_shear(made, 12, 20, 1, 0.012F);  // 2 km from a stronger peak
    set_shear(made, 15, 20, 0, 0.01F);   // 5 km, which is far enough
    set_shear(made, 30, 5, 4, 0.02F);
    set_shear(made, 40, 30, 1, -0.03F);   // anticyclonic
    set_shear(made, 45, 35, 1, 0.0055F);  // weak
    set_shear(made, 20, 35, 15, 0.05F);   // above the layer
    const auto peaks = peaks_of_grid(made);
    ASSERT_EQ(peaks.size(), 3U);
    EXPECT_NEAR(peaks[0].azimuthal_per_s, 0.02F, half_code_per_s);
    EXPECT_EQ(peaks[0].height_m, 2500);
    EXPECT_NEAR(peaks[1].azimuthal_per_s, 0.0123F, half_code_per_s);
    EXPECT_EQ(peaks[1].height_m, 1500);
    EXPECT_EQ(peaks[1].ix, 10);
    EXPECT_EQ(peaks[2].ix, 15);
    const grid::GeoPoint place = grid::GridProjection(made.spec).to_geo({10, 20});
    EXPECT_EQ(peaks[1].position.latitude_deg, place.latitude_deg);
    EXPECT_EQ(peaks[1].position.longitude_deg, place.longitude_deg);
}

TEST(ShearPeaks, IncludeBothBoundsOfTheLayer) {
    grid::Grid made = no_shear();
    set_shear(made, 5, 5, 0, 0.01F);    // 500 m
    set_shear(made, 15, 5, 1, 0.011F);  // 1000 m
    set_shear(made, 25, 5, 3, 0.012F);  // 2000 m
    set_shear(made, 35, 5, 4, 0.013F);  // 2500 m
    const auto peaks = peaks_of_grid(made, {.bottom_m = 1000, .top_m = 2000});
    ASSERT_EQ(peaks.size(), 2U);
    EXPECT_EQ(peaks[0].ix, 25);
    EXPECT_EQ(peaks[1].ix, 15);
}

TEST(ShearPeaks, OfEmptyLayersAndGridsAreNone) {
    grid::Grid made = no_shear();
    EXPECT_TRUE(peaks_of_grid(made).empty());
    set_shear(made, 5, 5, 0, 0.01F);
    EXPECT_TRUE(peaks_of_grid(made, {.bottom_m = 20'000, .top_m = 30'000}).empty());
    EXPECT_TRUE(peaks_of_grid(made, {.bottom_m = 3000, .top_m = 1000}).empty());
    EXPECT_TRUE(peaks_of_grid(made, {.most = 0}).empty());
    EXPECT_EQ(peaks_of_grid(made).size(), 1U);
    made.status.assign(made.status.size(), CellStatus::ambiguous);
    EXPECT_TRUE(peaks_of_grid(made).empty());
}

// Compares the peaks with those of a search that looks at each column again for each peak.
TEST(ShearPeaks, AreThoseOfASlowSearch) {
    grid::Grid made = no_shear();
    std::mt19937 random(48);
    std::uniform_real_distribution<float> shear(-0.01F, 0.02F);
    for (int i = 0; i < 3000; ++i) {
        set_shear(made, static_cast<int>(random() % 50), static_cast<int>(random() % 37),
                  static_cast<int>(random() % 20), shear(random));
    }
    const auto bricks = grid::BrickGrid::from(made, grid::default_quantization(made.moment));
    const grid::BrickView view = bricks.view();
    const ShearPeakOptions options{.most = 1000};
    std::vector<ShearPeak> slow;
    for (bool has_found = true; has_found;) {
        ShearPeak best;
        has_found = false;
        for (int iy = 0; iy < made.spec.ny; ++iy) {
            for (int ix = 0; ix < made.spec.nx; ++ix) {
                bool is_near = false;
                for (const ShearPeak& one : slow)
                    is_near = is_near || std::hypot(one.ix - ix, one.iy - iy) < 5;
                for (int level = 0; level < 6 && !is_near; ++level) {
                    if (view.status(ix, iy, level) != CellStatus::value) continue;
                    const float value = view.value(ix, iy, level) / 1000;
                    if (value < options.least_per_s || value <= best.azimuthal_per_s) continue;
                    best.ix = ix;
                    best.iy = iy;
                    best.azimuthal_per_s = value;
                    best.height_m = made.spec.levels_m[static_cast<std::size_t>(level)];
                    has_found = true;
                }
            }
        }
        if (has_found) slow.push_back(best);
    }
    const auto peaks = shear_peaks(view, options);
    ASSERT_GT(slow.size(), 30U);
    ASSERT_EQ(peaks.size(), slow.size());
    for (std::size_t i = 0; i < slow.size(); ++i) {
        EXPECT_EQ(peaks[i].ix, slow[i].ix);
        EXPECT_EQ(peaks[i].iy, slow[i].iy);
        EXPECT_EQ(peaks[i].azimuthal_per_s, slow[i].azimuthal_per_s);
        EXPECT_EQ(peaks[i].height_m, slow[i].height_m);
    }
}

}  // namespace
}  // namespace stormcellar::retrieve
