// Tests the work that is timed to predict the time of a grid. bench/bench_plan checks the times.
#include "grid/plan/grid_cost.h"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "grid/plan/grid_effects.h"
#include "tests/grid/square_spec.h"
#include "tests/grid/volume_maker.h"

namespace stormcellar::grid {
namespace {

const SitePosition site{"KTLX", 35.3333, -97.2778, 389};

// Returns a volume with echo in the east, within 75 km and again farther out.
level2::Volume half_volume(level2::Moment moment = level2::Moment::ref) {
    SweepPlan plan;
    plan.moment = moment;
    plan.code = [](int radial, int gate) {
        return radial < 180 ? static_cast<std::uint16_t>(90 + (radial * 7 + gate * 3) % 60)
                            : below_threshold;
    };
    return make_volume(plans_at({0.5, 1.5, 2.5, 3.5}, plan));
}

GridScene scene_of(const level2::Volume& volume, int side, level2::Moment moment, int threads = 1) {
    GridSpec spec = square_spec(site.latitude_deg, site.longitude_deg, side);
    SceneOptions options;
    options.moment = moment;
    options.threads = threads;
    return GridScene::make(volume, site, spec, options).value();
}

bool has_echo(const GridScene& scene, const Tile& tile) {
    bool any = false;
    for (int iy = tile.first_y; iy < tile.end_y; ++iy) {
        for (int ix = tile.first_x; ix < tile.end_x; ++ix)
            any = any || scene.may_hold_value(ix, iy);
    }
    return any;
}

TEST(TileSample, StrataHoldEveryTileWithinReachAndSpreadAlongTheArc) {
    const level2::Volume volume = half_volume();
    GridScene scene = scene_of(volume, 400, level2::Moment::ref);
    const TileSample sample = draw_tiles(scene, 32);
    std::size_t within = 0;
    std::size_t with_echo = 0;
    float farthest_m = 0;
    for (const Tile& tile : scene.tiles()) {
        if (!(tile.bounds.least_arc_m < static_cast<float>(scene.reach_m()))) continue;
        ++within;
        with_echo += has_echo(scene, tile) ? 1 : 0;
        farthest_m = std::max(farthest_m, tile.bounds.least_arc_m);
    }
    EXPECT_EQ(sample.with_echo.count, with_echo);
    EXPECT_EQ(sample.without.count, within - with_echo);
    EXPECT_GT(with_echo, 0U);
    EXPECT_LT(with_echo, within);
    for (const auto* stratum : {&sample.with_echo, &sample.without}) {
        ASSERT_EQ(stratum->tiles.size(), 32U);
        std::set<std::pair<int, int>> places;
        for (const Tile& tile : stratum->tiles) {
            EXPECT_EQ(has_echo(scene, tile), stratum == &sample.with_echo);
            EXPECT_TRUE(places.emplace(tile.first_x, tile.first_y).second)
                << "a tile was drawn twice";
        }
        // Both pieces of 16 tiles have near and far tiles.
        for (const std::size_t first : {std::size_t{0}, std::size_t{16}}) {
            EXPECT_LT(stratum->tiles[first].bounds.least_arc_m, farthest_m / 3);
            EXPECT_GT(stratum->tiles[first + 15].bounds.least_arc_m, farthest_m * 2 / 3);
        }
    }
}

TEST(TileSample, OfFewTilesTakesAll) {
    const level2::Volume volume = half_volume();
    GridScene scene = scene_of(volume, 24, level2::Moment::ref);
    const TileSample sample = draw_tiles(scene, 32);
    EXPECT_EQ(sample.with_echo.count, sample.with_echo.tiles.size());
    EXPECT_EQ(sample.without.count, sample.without.tiles.size());
    EXPECT_EQ(sample.with_echo.count + sample.without.count, 9U);
}

TEST(PredictedCosts, AreSaidOfEveryStepAndOfWhatInterpolationAndExtentTakeTogether) {
    for (const level2::Moment moment : {level2::Moment::ref, level2::Moment::vel}) {
        const level2::Volume volume = half_volume(moment);
        for (const int threads : {1, 2}) {
            GridScene scene = scene_of(volume, 160, moment, threads);
            accuracy::Chain chain = effects_of(moment);
            ASSERT_TRUE(predict_costs(scene, chain));
            EXPECT_TRUE(accuracy::validate(chain));
            EXPECT_EQ(chain.joint_costs.size(), interpolation_facts.size() - 1)
                << "one cost for each interpolation except the cheapest";
            EXPECT_GT(chain.cheapest_cost_s, 0);
            // The costs are a factor of ten apart on a quiet machine, so no load reverses their
            // order.
            accuracy::Choice cheapest;
            accuracy::Choice exact;
            for (const accuracy::Step& step : chain.steps) {
                cheapest.rungs.push_back(0);
                exact.rungs.push_back(step.effects.size());
            }
            EXPECT_GT(accuracy::cost_s(chain, exact), accuracy::cost_s(chain, cheapest));
            // For a grid centered at the site, every site frame has a closed form, which costs
            // nothing.
            EXPECT_EQ(chain.steps[0].effects[1].cost_s, 0);
        }
    }
}

}  // namespace
}  // namespace stormcellar::grid
