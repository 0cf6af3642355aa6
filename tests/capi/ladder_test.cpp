// Measures, by the C interface, the accuracy of gridding a real volume. Compares the results with
// those of the C++ library.
#include "stormcellar/accuracy/ladder.h"

#include <memory>

#include "grid/plan/grid_ladder.h"
#include "stormcellar/level2/decode.h"
#include "tests/capi/opened.h"
#include "tests/testing/data.h"

namespace stormcellar::testing {
namespace {

class CLadder : public ::testing::Test {
  protected:
    void SetUp() override {
        STORMCELLAR_NEED_DATA();
        volume_ = opened(real_file("volumes/KTLX19990503_235621.gz"));
        options_.size = sizeof options_;
        options_.columns = options_.rows = 60;
        options_.spacing_m = 4000;
        how_.size = sizeof how_;
        how_.columns = 100;
        how_.rounds = 1;
    }
    void TearDown() override { stormcellar_ladder_free(ladder_); }
    stormcellar_code measure() {
        return stormcellar_ladder_measure(volume_.get(), &options_, &how_, &ladder_, &count_,
                                          &error_);
    }
    OpenedVolume volume_;
    stormcellar_grid_options options_{};
    stormcellar_ladder_options how_{};
    stormcellar_ladder* ladder_ = nullptr;
    std::size_t count_ = 0;
    stormcellar_error error_{};
};

TEST_F(CLadder, ErrorsAreThoseOfTheLibrary) {
    ASSERT_EQ(measure(), STORMCELLAR_OK) << error_.message;
    const auto decoded = level2::decode_file(real_file("volumes/KTLX19990503_235621.gz"));
    const auto antenna = level2::antenna_position(decoded->volume);
    const grid::SitePosition site{"KTLX", antenna->latitude_deg, antenna->longitude_deg,
                                  antenna->altitude_m};
    grid::GridSpec spec = grid::default_spec(site.latitude_deg, site.longitude_deg);
    spec.nx = spec.ny = 60;
    spec.spacing_m = 4000;
    auto scene = grid::GridScene::make(decoded->volume, site, spec, {});
    ASSERT_TRUE(scene);
    grid::LadderOptions how;
    how.columns = 100;
    how.rounds = 1;
    const auto rows = grid::run_ladder(*scene, how);
    ASSERT_TRUE(rows);
    ASSERT_EQ(count_, rows->size());
    int with_errors = 0;
    for (std::size_t i = 0; i < count_; ++i) {
        auto rung = empty_facts<stormcellar_rung>();
        ASSERT_EQ(stormcellar_ladder_describe(ladder_, i, &rung, nullptr), STORMCELLAR_OK);
        const accuracy::LadderRow& row = (*rows)[i];
        EXPECT_EQ(rung.step, row.step);
        EXPECT_EQ(rung.name, row.name);
        EXPECT_STREQ(rung.value_unit, "dB");
        EXPECT_EQ(rung.rung, static_cast<int>(row.rung));
        ASSERT_TRUE(row.value);
        EXPECT_EQ(rung.value_rms, row.value->rms);
        EXPECT_EQ(rung.value_p99, row.value->p99);
        EXPECT_EQ(rung.value_max, row.value->max);
        EXPECT_EQ(rung.position_max_m, row.position_max_m);
        EXPECT_EQ(rung.status_disagreement, row.status->share());
        EXPECT_GT(rung.time_s, 0);
        if (rung.value_rms > 0) ++with_errors;
    }
    EXPECT_GT(with_errors, 5);
}

TEST_F(CLadder, WhatMakesNoSenseIsRefused) {
    how_.rounds = -1;
    EXPECT_EQ(measure(), STORMCELLAR_BAD_ARGUMENT);
    how_.rounds = 1;
    options_.moment = "ZDR";
    EXPECT_EQ(measure(), STORMCELLAR_NOT_FOUND) << "there was no dual polarization in 1999";
    options_.moment = "VEL";
    options_.average_in_z = 1;
    EXPECT_EQ(measure(), STORMCELLAR_BAD_ARGUMENT);
    EXPECT_EQ(ladder_, nullptr);
    EXPECT_EQ(stormcellar_ladder_measure(nullptr, nullptr, nullptr, nullptr, nullptr, nullptr),
              STORMCELLAR_BAD_ARGUMENT);
    EXPECT_EQ(stormcellar_ladder_describe(nullptr, 0, nullptr, nullptr), STORMCELLAR_BAD_ARGUMENT);
}

}  // namespace
}  // namespace stormcellar::testing
