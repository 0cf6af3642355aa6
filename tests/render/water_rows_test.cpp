#include "render/products/water_rows.h"

#include <limits>

#include <gtest/gtest.h>

namespace stormcellar::render {
namespace {

// Returns a mask of land with a lake, a sea in the east, and a strip that is half water.
WaterMask mask_of(int width, int height) {
    WaterMask mask;
    mask.west_m = -1000;
    mask.north_m = 2000;
    mask.metres_per_cell = 10;
    mask.width = width;
    mask.height = height;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const bool is_lake = x >= 37 && x < 45 && y >= 20 && y < 33;
            const bool is_sea = x >= 130;
            mask.water.push_back(is_lake || is_sea ? 255 : y >= 64 && y < 96 ? 128 : 0);
        }
    }
    return mask;
}

GroundRow straight_row(GroundPoint from, GroundPoint step, std::size_t width) {
    GroundRow row;
    for (std::size_t i = 0; i < width; ++i) {
        row.x_m.push_back(from.x_m + static_cast<double>(i) * step.x_m);
        row.y_m.push_back(from.y_m + static_cast<double>(i) * step.y_m);
    }
    return row;
}

void expect_the_bits_of_single_places(const WaterMask& mask, const GroundRow& row) {
    WaterRow found;
    WaterRows(mask).find(row, found);
    ASSERT_EQ(found.share.size(), row.x_m.size());
    for (std::size_t i = 0; i < row.x_m.size(); ++i) {
        if (row.is_sky(i)) continue;
        const GroundPoint at{row.x_m[i], row.y_m[i]};
        ASSERT_EQ(found.share[i], mask.water_at(at)) << at.x_m << " " << at.y_m;
    }
}

TEST(WaterRows, HaveTheBitsOfSinglePlaces) {
    for (const auto& [width, height] : {std::pair{200, 150}, {131, 1}, {1, 70}, {1, 1}, {16, 16}}) {
        const WaterMask mask = mask_of(width, height);
        for (const GroundPoint step : {GroundPoint{10, 0}, {3.7, 0}, {7, -6}, {-9, 31}, {400, 5}}) {
            for (double y_m = 2300; y_m > 0; y_m -= 27.3) {
                const double x_m = step.x_m < 0 ? 1300 : -1200;
                expect_the_bits_of_single_places(mask, straight_row({x_m, y_m}, step, 173));
            }
        }
    }
}

TEST(WaterRows, SkyInTheRowChangesNoOtherPixel) {
    const WaterMask mask = mask_of(200, 150);
    GroundRow row = straight_row({-1000, 1900}, {10, -1}, 100);
    for (std::size_t i = 0; i < 21; ++i)
        row.x_m[i] = row.y_m[i] = std::numeric_limits<double>::quiet_NaN();
    expect_the_bits_of_single_places(mask, row);
}

}  // namespace
}  // namespace stormcellar::render
