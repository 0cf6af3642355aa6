// Checks the promises of the planner for mosaics (frames) of real volumes, as
// tests/grid/honesty_test.cpp does for one volume. Frames are of one site between its volumes, and
// of several sites.
//
// - An effect that the planner left off changes the frame by less than the budget if the effect is
//   forced on.
// - An effect that the planner turned on changes the frame by more than a tenth of the budget if
//   the effect is forced off, in at least one scene for each effect.
// - The chosen frame differs from the exact chain's frame by at most the budget.
#include "pipeline/plan/mosaic_plan.h"

#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "grid/cells/compare_bricks.h"
#include "stormcellar/level2/decode.h"
#include "tests/testing/data.h"
#include "tests/testing/forced_choice.h"

namespace stormcellar::pipeline {
namespace {

constexpr double stated_part = 0.1;

struct HonestScene {
    std::vector<const char*> files;
    const char* budget;
    const char* time;
    int side = 100;
    double spacing_m = 4000;
    double latitude_deg = 42.2, longitude_deg = -75.98;  // KBGM
    grid::Overlap overlap = grid::Overlap::distance_weighted;
};

const char* const bgm1 = "sequence-kbgm/KBGM20050822_024414.gz";
const char* const bgm2 = "sequence-kbgm/KBGM20050822_025001.gz";
const char* const bgm3 = "sequence-kbgm/KBGM20050822_025549.gz";
const char* const ne_bgm = "mosaic-northeast/KBGM20100911_012056_V03.gz";
const char* const ne_enx = "mosaic-northeast/KENX20100911_011108_V03.gz";
const char* const ne_okx = "mosaic-northeast/KOKX20100911_011047_V03.gz";
const char* const ne_dix = "mosaic-northeast/KDIX20100911_011759_V03.gz";
const char* const ne_cxx = "mosaic-northeast/KCCX20100911_013442_V03.gz";
const char* const ne_tyx = "mosaic-northeast/KTYX20100911_012210_V04.gz";

const std::vector<HonestScene>& scenes() {
    static const std::vector<HonestScene> list = {
        {{bgm1, bgm2}, "1 km, 6 dB", "2005-08-22T02:50:00Z", 150, 2000},
        {{bgm1, bgm2}, "8 km, 14 dB", "2005-08-22T02:51:30Z"},
        {{bgm1, bgm2, bgm3}, "4 km, 9 dB", "2005-08-22T02:55:00Z", 150, 2000},
        {{bgm2, bgm3}, "900 m, 3 dB", "2005-08-22T02:56:00Z", 120, 1500},
        {{bgm1, bgm2}, "200 m, 0.4 dB", "2005-08-22T02:49:00Z", 60, 4000},
        {{ne_bgm, ne_enx, ne_okx, ne_dix}, "2 km, 6 dB", "2010-09-11T01:20:00Z", 120},
        {{ne_bgm, ne_cxx, ne_tyx}, "3 km, 12 dB", "2010-09-11T01:27:00Z", 90, 5000},
        {{ne_enx, ne_okx},
         "3 km, 3 dB",
         "2010-09-11T01:15:00Z",
         80,
         3000,
         41.6,
         -73.5,
         grid::Overlap::maximum},
        {{ne_enx, ne_okx},
         "3 km, 5 dB",
         "2010-09-11T01:15:00Z",
         80,
         3000,
         41.6,
         -73.5,
         grid::Overlap::nearest},
    };
    return list;
}

struct Prepared {
    std::vector<level2::Volume> volumes;
    accuracy::Budget budget;
    accuracy::Chain chain;
    std::optional<MosaicScene> scene;
    std::optional<MosaicPlan> plan;
};

std::unique_ptr<Prepared> prepare(const HonestScene& honest) {
    auto made = std::make_unique<Prepared>();
    std::vector<SceneVolume> sources;
    made->volumes.reserve(honest.files.size());
    for (const char* file : honest.files) {
        auto decoded = level2::decode_file(testing::real_file(file));
        EXPECT_TRUE(decoded);
        const auto antenna = level2::antenna_position(decoded->volume);
        made->volumes.push_back(std::move(decoded->volume));
        const level2::Volume& volume = made->volumes.back();
        sources.push_back(
            {&volume,
             {volume.station, antenna->latitude_deg, antenna->longitude_deg, antenna->altitude_m},
             file,
             false,
             {}});
    }
    grid::GridSpec spec = grid::default_spec(honest.latitude_deg, honest.longitude_deg);
    spec.nx = spec.ny = honest.side;
    spec.spacing_m = honest.spacing_m;
    MosaicSceneOptions options;
    options.frame.overlap.overlap = honest.overlap;
    options.frame.threads = 2;
    options.partial.gridder.threads = 2;
    options.instant = *parse_utc(honest.time, UtcTime{});
    made->budget = accuracy::parse_budget(honest.budget).value();
    made->chain = mosaic_effects_of(level2::Moment::ref, grid::Averaging::in_db, honest.overlap);
    auto scene = MosaicScene::make(sources, spec, made->chain, options);
    EXPECT_TRUE(scene) << (scene ? "" : scene.error().message);
    made->scene.emplace(std::move(*scene));
    auto plan = plan_mosaic(*made->scene, made->chain, made->budget);
    EXPECT_TRUE(plan) << (plan ? "" : plan.error().message);
    made->plan.emplace(std::move(*plan));
    return made;
}

MosaicFrame frame_of(Prepared& prepared, const accuracy::Choice& choice) {
    auto frame = prepared.scene->frame(mosaic_choice(prepared.chain, choice));
    EXPECT_TRUE(frame);
    return std::move(*frame);
}

double difference(const MosaicFrame& a, const MosaicFrame& b) {
    const auto found = grid::compare_bricks(a.mosaic.cells.view(), b.mosaic.cells.view(), 2);
    EXPECT_TRUE(found);
    const auto summary = found->summary();
    return summary ? summary->p99 : 0;
}

class MosaicHonesty : public ::testing::TestWithParam<std::size_t> {};

TEST_P(MosaicHonesty, WhatIsLeftOffIsLessThanTheBudget) {
    STORMCELLAR_NEED_DATA();
    const auto prepared = prepare(scenes()[GetParam()]);
    const accuracy::Plan& plan = prepared->plan->plan;
    ASSERT_TRUE(plan.meets_budget) << plan.shortfall;
    SCOPED_TRACE(plan.description);
    const MosaicFrame chosen = frame_of(*prepared, plan.choice);
    accuracy::Choice all = plan.choice;
    double position_m = 0;
    for (const accuracy::Decision& decision : plan.decisions) {
        if (decision.on || decision.effect == "exact_geodesic") continue;
        position_m += decision.predicted.position_m;
        const accuracy::Choice one = testing::forced(plan, prepared->chain, decision.effect, true);
        for (std::size_t i = 0; i < all.rungs.size(); ++i)
            all.rungs[i] = std::max(all.rungs[i], one.rungs[i]);
        EXPECT_LE(difference(chosen, frame_of(*prepared, one)), *prepared->budget.value)
            << decision.effect;
    }
    EXPECT_LE(position_m, *prepared->budget.position_m);
    EXPECT_LE(difference(chosen, frame_of(*prepared, all)), *prepared->budget.value)
        << "with all effects that were left off";
    const MosaicFrame exact = frame_of(*prepared, grid::reference_choice(prepared->chain));
    EXPECT_LE(difference(chosen, exact), *prepared->budget.value)
        << "compared with the exact chain";
}

INSTANTIATE_TEST_SUITE_P(Scenes, MosaicHonesty, ::testing::Range<std::size_t>(0, scenes().size()));

TEST(MosaicHonesty, EveryEffectOfMosaicsMattersInSomeScene) {
    STORMCELLAR_NEED_DATA();
    std::map<std::string, double> greatest_part;
    for (const HonestScene& honest : scenes()) {
        const auto prepared = prepare(honest);
        const accuracy::Plan& plan = prepared->plan->plan;
        const MosaicFrame chosen = frame_of(*prepared, plan.choice);
        for (const accuracy::Decision& decision : plan.decisions) {
            // Skip effects that were turned on because they cost nothing, or because they are part
            // of the most accurate choice.
            if (!decision.on || !decision.reason.starts_with("without it")) continue;
            const accuracy::Choice without =
                testing::forced(plan, prepared->chain, decision.effect, false);
            const double change = difference(chosen, frame_of(*prepared, without));
            const double part =
                std::max(change / *prepared->budget.value,
                         decision.predicted.position_m / *prepared->budget.position_m);
            greatest_part[decision.effect] = std::max(greatest_part[decision.effect], part);
        }
    }
    for (const char* effect :
         {"time_blend", "echo_motion", "sweep_times", "site_overlap", "fine_codes"}) {
        ASSERT_TRUE(greatest_part.contains(effect)) << effect << " is never turned on";
        EXPECT_GT(greatest_part[effect], stated_part) << effect;
    }
}

TEST(MosaicPlan, OfVolumesWithoutAPairHasNoEffectOfTime) {
    STORMCELLAR_NEED_DATA();
    const auto prepared = prepare(scenes()[7]);
    for (const accuracy::Decision& decision : prepared->plan->plan.decisions) {
        if (decision.step != "time" && decision.step != "sweeps") continue;
        EXPECT_EQ(decision.predicted, accuracy::ErrorSize{}) << decision.effect;
    }
}

// The echo moves at 13.5 m/s (docs/accuracy.md) for the minutes between the middle of a volume and
// the instant.
TEST(MosaicPlan, EchoMotionIsAsFarAsEchoMoves) {
    STORMCELLAR_NEED_DATA();
    const auto prepared = prepare(scenes()[0]);
    for (const accuracy::Decision& decision : prepared->plan->plan.decisions) {
        if (decision.effect != "echo_motion") continue;
        EXPECT_GT(decision.predicted.position_m, 13.5 * 120);
        EXPECT_LT(decision.predicted.position_m, 30 * 348);
        return;
    }
    FAIL() << "the chain has no echo_motion";
}

TEST(MosaicPlan, WithoutABudgetIsTheDefault) {
    STORMCELLAR_NEED_DATA();
    const auto prepared = prepare(scenes()[0]);
    const auto plan = plan_mosaic(*prepared->scene, prepared->chain, std::nullopt);
    ASSERT_TRUE(plan);
    EXPECT_EQ(plan->choice, prepared->scene->default_choice());
    EXPECT_EQ(plan->choice.time, grid::TimeMethod::advected);
    EXPECT_TRUE(plan->choice.sweep_times);
    EXPECT_TRUE(plan->choice.mixes_sites);
    EXPECT_FALSE(plan->choice.fine_codes);
}

// The test uses the largest values that radars send (docs/level2.md).
TEST(MosaicPlan, FineCodesHoldAllThatRadarsSend) {
    const std::map<level2::Moment, float> largest = {{level2::Moment::ref, 94.5F},
                                                     {level2::Moment::sw, 63.5F},
                                                     {level2::Moment::zdr, 20.0F},
                                                     {level2::Moment::rho, 1.06F},
                                                     {level2::Moment::cfp, 126.0F}};
    for (const auto& [moment, most] : largest) {
        const grid::Quantization coarse = quantization_of(moment, false);
        const grid::Quantization fine = quantization_of(moment, true);
        EXPECT_LE(fine.step, coarse.step / 16);
        EXPECT_EQ(fine.first_value, coarse.first_value);
        EXPECT_GE(fine.value_of(fine.largest_code()), most) << level2::moment_name(moment);
    }
}

}  // namespace
}  // namespace stormcellar::pipeline
