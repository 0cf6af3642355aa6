// Tests three promises of the planner of pictures, with scenes of real volumes and of a simulated
// storm. If an effect that the planner left off is forced on, the picture changes by at most the
// budget. If an effect that the planner turned on is forced off, the picture changes by more than a
// tenth of the budget in at least one scene. (This does not hold for step_attenuation.) The chosen
// picture differs from the exact chain's picture by at most the budget.
#include "render/plan/volume_plan.h"

#include <cmath>
#include <map>
#include <memory>

#include <gtest/gtest.h>

#include "render/color/color_difference.h"
#include "stormcellar/grid/column_geometry.h"
#include "stormcellar/grid/gridder.h"
#include "stormcellar/level2/decode.h"
#include "tests/render/real_volume.h"
#include "tests/render/synthetic_storm.h"
#include "tests/testing/data.h"
#include "tests/testing/forced_choice.h"

namespace stormcellar::render {
namespace {

constexpr double stated_part = 0.1;
constexpr int width = 160, height = 110;

struct PlannedScene {
    const char* file;  // none: the simulated storm
    double spacing_m;
    const char* budget;
    Scene scene;
};

Scene seen(const Camera& camera, double exaggeration, double opacity = 1) {
    Scene scene;
    scene.camera = camera;
    scene.vertical_exaggeration = exaggeration;
    scene.opacity = opacity;
    return scene;
}

Camera perspective(double azimuth_deg, double tilt_deg, double field_of_view_deg) {
    Camera camera{azimuth_deg, tilt_deg, 1};
    camera.field_of_view_deg = field_of_view_deg;
    return camera;
}

Scene lit(const std::string& light, Scene scene) {
    EXPECT_TRUE(set_light(light, scene.light));
    return scene;
}

const std::vector<PlannedScene>& scenes() {
    static const std::vector<PlannedScene> all = {
        {"sequence-kbgm/KBGM20050822_024414.gz", 3000, "dE 2", seen({180, 20, 1}, 5)},
        {"sequence-kbgm/KBGM20050822_024414.gz", 3000, "dE 0.4", seen({180, 55, 1}, 5)},
        {"volumes/KLIX20050828_180149.gz", 3000, "dE 5", seen({200, 60, 1}, 8)},
        {"volumes/KLIX20050828_180149.gz", 3000, "dE 0.8", seen(perspective(150, 70, 60), 8, 6)},
        {"volumes/KOKX20080109_141449.gz", 4000, "dE 3", seen({120, 75, 1.5}, 10, 3)},
        {nullptr, 4000, "dE 1", seen({180, 85, 1}, 8)},
        {"sequence-kbgm/KBGM20050822_024414.gz", 10000, "dE 2", seen({180, 20, 3}, 5)},
        {"volumes/KLIX20050828_180149.gz", 4000, "dE 2",
         lit("gradient,shadow,scattering", seen({180, 60, 1}, 8, 10))},
        {"sequence-kbgm/KBGM20050822_024414.gz", 4000, "dE 3",
         lit("shadow", seen({180, 55, 1}, 5, 4))},
        {"volumes/KLIX20050828_180149.gz", 5000, "dE 2", seen({180, 60, 1}, 8, 40)},
    };
    return all;
}

grid::BrickGrid bricks_for(const PlannedScene& planned) {
    if (planned.file == nullptr) {
        return bricks_of(storm_grid(small_spec(150, 24, planned.spacing_m, 700)));
    }
    const grid::Grid grid = real_reflectivity(planned.file, planned.spacing_m,
                                              static_cast<int>(460e3 / planned.spacing_m));
    return grid::BrickGrid::from(grid, grid::default_quantization(level2::Moment::ref));
}

struct Prepared {
    grid::BrickGrid bricks;
    VolumeScene scene;
    accuracy::Chain chain;
    accuracy::Budget budget;
    std::optional<VolumePlan> plan;

    explicit Prepared(const PlannedScene& planned)
        : bricks(bricks_for(planned)),
          scene(bricks.view(), nws_reflectivity(), planned.scene, width, height, 2),
          chain(volume_chain(planned.scene.light)),
          budget(*accuracy::parse_budget(planned.budget)) {
        plan = *plan_volume(scene, chain, budget, {});
    }
    double difference(const accuracy::Choice& one, const accuracy::Choice& other) {
        const Image first = scene.draw(volume_choice(chain, one)).picture;
        return image_difference(first, scene.draw(volume_choice(chain, other)).picture)
            ->percentile_99;
    }
};

// Returns a prepared scene. Each scene is made once for all tests, because it needs some 15
// pictures.
Prepared& prepared(std::size_t number) {
    static std::map<std::size_t, std::unique_ptr<Prepared>> all;
    auto& one = all[number];
    if (!one) one = std::make_unique<Prepared>(scenes()[number]);
    return *one;
}

class PictureHonesty : public ::testing::TestWithParam<std::size_t> {};

TEST_P(PictureHonesty, WhatIsLeftOffIsLessThanTheBudget) {
    STORMCELLAR_NEED_DATA();
    Prepared& scene = prepared(GetParam());
    const accuracy::Plan& plan = scene.plan->plan;
    ASSERT_TRUE(plan.meets_budget) << plan.shortfall;
    SCOPED_TRACE(plan.description);
    accuracy::Choice all = plan.choice;
    for (const accuracy::Decision& decision : plan.decisions) {
        if (decision.on || !decision.is_asked) continue;
        const auto one = testing::forced(plan, scene.chain, decision.effect, true);
        for (std::size_t i = 0; i < all.rungs.size(); ++i)
            all.rungs[i] = std::max(all.rungs[i], one.rungs[i]);
        EXPECT_LE(scene.difference(plan.choice, one), *scene.budget.image_de) << decision.effect;
    }
    EXPECT_LE(scene.difference(plan.choice, all), *scene.budget.image_de);
}

TEST_P(PictureHonesty, ThePictureIsWithinTheBudgetOfTheExactOne) {
    STORMCELLAR_NEED_DATA();
    Prepared& scene = prepared(GetParam());
    EXPECT_LE(scene.difference(scene.plan->plan.choice, accuracy::exact_choice(scene.chain)),
              *scene.budget.image_de)
        << scene.plan->plan.description;
}

INSTANTIATE_TEST_SUITE_P(Scenes, PictureHonesty, ::testing::Range(std::size_t{0}, scenes().size()));

TEST(PictureHonesty, EveryEffectMattersSomewhere) {
    STORMCELLAR_NEED_DATA();
    std::map<std::string, double> largest;  // of effects that were on, as a share of the budget
    for (const accuracy::Step& step : volume_chain().steps) {
        for (const accuracy::Effect& effect : step.effects)
            largest[effect.name] = 0;
    }
    for (std::size_t number = 0; number < scenes().size(); ++number) {
        Prepared& scene = prepared(number);
        const accuracy::Plan& plan = scene.plan->plan;
        for (const accuracy::Decision& decision : plan.decisions) {
            if (!decision.on) continue;
            const auto without = testing::forced(plan, scene.chain, decision.effect, false);
            largest[decision.effect] =
                std::max(largest[decision.effect],
                         scene.difference(plan.choice, without) / *scene.budget.image_de);
        }
    }
    // With 2,048 slices, no step is thick enough to hide its own far part, so no plan turns
    // step_attenuation on.
    EXPECT_EQ(largest["step_attenuation"], 0);
    largest.erase("step_attenuation");
    for (const auto& [effect, part] : largest)
        EXPECT_GT(part, stated_part) << effect;
}

// The plan reports the size of light that the scene does not ask for, but the choice of the plan
// does not change.
TEST(PictureHonesty, LightIsOffUnlessTheSceneAsksForIt) {
    STORMCELLAR_NEED_DATA();
    // Light is visible where echo is opaque; scattering differs from shadows where echo is thick.
    PlannedScene unlit = scenes().front();
    unlit.scene.opacity = 10;
    unlit.scene.light.sun_elevation_deg = 15;
    Prepared scene(unlit);
    const auto all = *plan_volume(scene.scene, scene.chain, scene.budget, {}, Predicted::all);
    EXPECT_EQ(all.choice, scene.plan->choice);
    EXPECT_EQ(all.plan.left_off.image_de, scene.plan->plan.left_off.image_de);
    int lights = 0;
    for (const accuracy::Decision& decision : all.plan.decisions) {
        if (!decision.effect.ends_with("_light")) continue;
        ++lights;
        EXPECT_FALSE(decision.on);
        EXPECT_FALSE(decision.is_asked);
        EXPECT_EQ(decision.reason, "the scene does not ask for it");
        // The exposure removes the part of scattering that is the same everywhere, but the rest is
        // visible.
        EXPECT_GT(decision.predicted.image_de, 0.5) << decision.effect;
    }
    EXPECT_EQ(lights, 3);
}

TEST(PictureHonesty, StepsHideThemselvesWhereTheyAreThick) {
    STORMCELLAR_NEED_DATA();
    Prepared& opaque = prepared(scenes().size() - 1);
    accuracy::Choice few = accuracy::exact_choice(opaque.chain);
    few.rungs[0] = 0;
    EXPECT_GT(opaque.difference(
                  few, testing::forced(opaque.plan->plan, opaque.chain, "step_attenuation", false)),
              1);
}

}  // namespace
}  // namespace stormcellar::render
