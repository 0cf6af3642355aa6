// Grids real volumes by the C interface, and compares every cell with that of the C++ library.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "stormcellar/grid/gridder.h"
#include "stormcellar/level2/decode.h"
#include "tests/capi/opened.h"
#include "tests/testing/data.h"

namespace stormcellar::testing {
namespace {

class CGrid : public ::testing::Test {
  protected:
    void SetUp() override {
        STORMCELLAR_NEED_DATA();
        volume_ = opened(real_file("volumes/KTLX19990503_235621.gz"));
        options_.size = sizeof options_;
    }
    stormcellar_code make() {
        stormcellar_grid* made = nullptr;
        const stormcellar_code code =
            stormcellar_grid_make(volume_.get(), &options_, &made, &error_);
        grid_.reset(made);
        return code;
    }
    OpenedVolume volume_;
    stormcellar_grid_options options_{};
    stormcellar_error error_{};
    OwnedGrid grid_;
};

TEST_F(CGrid, CellsAreThoseOfTheLibrary) {
    const double levels[] = {1000, 2000, 5000};
    options_.columns = 120;
    options_.rows = 80;
    options_.spacing_m = 2000;
    options_.levels_m = levels;
    options_.level_count = 3;
    options_.moment = "VEL";
    options_.interpolation = "eight-point";
    ASSERT_EQ(make(), STORMCELLAR_OK) << error_.message;
    auto facts = empty_facts<stormcellar_grid_facts>();
    ASSERT_EQ(stormcellar_grid_describe(grid_.get(), &facts, nullptr), STORMCELLAR_OK);
    EXPECT_STREQ(facts.moment, "VEL");
    EXPECT_STREQ(facts.unit, "m/s");
    EXPECT_EQ(facts.columns, 120);
    EXPECT_EQ(facts.rows, 80);
    EXPECT_EQ(facts.levels, 3);
    EXPECT_EQ(facts.spacing_m, 2000);

    const auto decoded = level2::decode_file(real_file("volumes/KTLX19990503_235621.gz"));
    const auto antenna = level2::antenna_position(decoded->volume);
    const grid::SitePosition site{"KTLX", antenna->latitude_deg, antenna->longitude_deg,
                                  antenna->altitude_m};
    grid::GridSpec spec = grid::default_spec(site.latitude_deg, site.longitude_deg);
    spec.nx = 120;
    spec.ny = 80;
    spec.spacing_m = 2000;
    spec.levels_m = {1000, 2000, 5000};
    grid::GridderOptions gridder;
    gridder.moment = level2::Moment::vel;
    gridder.method.interpolation = grid::Interpolation::eight_point;
    const auto expected =
        grid::make_grid(decoded->volume, site, **grid::make_column_geometry(site, spec), gridder);
    ASSERT_TRUE(expected);
    const float* values = nullptr;
    const std::uint8_t* states = nullptr;
    const double* heights = nullptr;
    ASSERT_EQ(stormcellar_grid_values(grid_.get(), &values, nullptr), STORMCELLAR_OK);
    ASSERT_EQ(stormcellar_grid_states(grid_.get(), &states, nullptr), STORMCELLAR_OK);
    ASSERT_EQ(stormcellar_grid_levels(grid_.get(), &heights, nullptr), STORMCELLAR_OK);
    EXPECT_EQ(heights[2], 5000);
    const std::size_t count = spec.cell_count();
    EXPECT_EQ(std::memcmp(values, expected->values.data(), count * sizeof(float)), 0);
    EXPECT_EQ(std::memcmp(states, expected->status.data(), count), 0);
    const auto with_value = std::count(states, states + count, STORMCELLAR_CELL_VALUE);
    EXPECT_GT(with_value, 3000);
    // The place of a cell, as the header says.
    EXPECT_EQ((7 * 120 + 5) * 3 + 2, static_cast<int>(spec.index(5, 7, 2)));
}

TEST_F(CGrid, DefaultsAreThoseOfTheCommandLine) {
    ASSERT_EQ(make(), STORMCELLAR_OK) << error_.message;
    auto facts = empty_facts<stormcellar_grid_facts>();
    ASSERT_EQ(stormcellar_grid_describe(grid_.get(), &facts, nullptr), STORMCELLAR_OK);
    EXPECT_STREQ(facts.moment, "REF");
    EXPECT_EQ(facts.columns, 460);
    EXPECT_EQ(facts.levels, 32);
    EXPECT_NEAR(facts.center_latitude_deg, 35.333, 0.01);
    EXPECT_EQ(facts.time_ms, 925775781000);
    EXPECT_LE(facts.start_ms, facts.end_ms);
}

TEST_F(CGrid, ACenterMovesTheGrid) {
    options_.columns = options_.rows = 20;
    options_.has_center = 1;
    options_.center_latitude_deg = 35.25;
    options_.center_longitude_deg = -97.69;
    ASSERT_EQ(make(), STORMCELLAR_OK) << error_.message;
    const float* values = nullptr;
    const std::uint8_t* states = nullptr;
    ASSERT_EQ(stormcellar_grid_values(grid_.get(), &values, nullptr), STORMCELLAR_OK);
    ASSERT_EQ(stormcellar_grid_states(grid_.get(), &states, nullptr), STORMCELLAR_OK);
    float largest = 0;
    for (int i = 0; i < 20 * 20 * 32; ++i)
        if (states[i] == STORMCELLAR_CELL_VALUE) largest = std::max(largest, values[i]);
    EXPECT_GT(largest, 55) << "the supercell is within 10 km of this place";
}

TEST_F(CGrid, WhatMakesNoSenseIsRefused) {
    const double falling[] = {2000, 1000};
    const auto refused = [&](auto change) {
        stormcellar_grid_options usual{};
        usual.size = sizeof usual;
        options_ = usual;
        change(options_);
        EXPECT_EQ(make(), STORMCELLAR_BAD_ARGUMENT) << error_.message;
        EXPECT_EQ(grid_, nullptr);
    };
    refused([](auto& options) { options.columns = -1; });
    refused([](auto& options) { options.spacing_m = std::nan(""); });
    refused([](auto& options) { options.moment = "DBZ"; });
    refused([](auto& options) { options.interpolation = "cubic"; });
    refused([](auto& options) { options.level_count = 2; });
    refused([&](auto& options) {
        options.levels_m = falling;
        options.level_count = 2;
    });
    refused([](auto& options) { options.threads = -1; });
    refused([](auto& options) {
        options.moment = "VEL";
        options.average_in_z = 1;
    });
    options_.size = 0;
    EXPECT_EQ(make(), STORMCELLAR_BAD_ARGUMENT);
    options_ = {};
    options_.size = sizeof options_;
    options_.moment = "ZDR";
    EXPECT_EQ(make(), STORMCELLAR_NOT_FOUND) << "there was no dual polarization in 1999";
    EXPECT_EQ(stormcellar_grid_make(nullptr, nullptr, nullptr, nullptr), STORMCELLAR_BAD_ARGUMENT);
    EXPECT_EQ(stormcellar_grid_values(nullptr, nullptr, nullptr), STORMCELLAR_BAD_ARGUMENT);
    stormcellar_grid_free(nullptr);
}

}  // namespace
}  // namespace stormcellar::testing
