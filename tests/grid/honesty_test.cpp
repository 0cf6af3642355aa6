// Checks the promises of the planner over real volumes of every kind:
// - If an effect that the plan left off is forced on, the grid changes by less than the budget.
// - If an effect that plans turned on for its size is forced off, the grid changes by more than a
//   tenth of the budget in at least one scene.
// - The planned grid differs from the oracle's grid by at most the budget.
#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include <gtest/gtest.h>

#include "grid/judge/oracle.h"
#include "grid/plan/cell_circle.h"
#include "grid/plan/grid_effects.h"
#include "stormcellar/accuracy/planner.h"
#include "stormcellar/grid/gridder.h"
#include "tests/grid/real_volume.h"
#include "tests/grid/square_spec.h"
#include "tests/testing/forced_choice.h"
#include "tests/testing/slow_down.h"

namespace stormcellar::grid {
namespace {

constexpr double stated_part = 0.1;

struct HonestScene {
    const char* file;
    const char* budget;
    level2::Moment moment = level2::Moment::ref;
    int side = 150;
    double spacing_m = 2000;
    double east_deg = 0;  // longitude of the grid's center minus the site's
    int columns = 40;     // columns that the oracle computes; wide cells take long
};

const std::vector<HonestScene>& scenes() {
    using level2::Moment;
    static const std::vector<HonestScene> list = {
        {"volumes/KTLX19990503_235621.gz", "800 m, 9 dB"},
        {"volumes/KTLX19990503_235621.gz", "100 m, 1 dB", Moment::ref, 100},
        {"volumes/KTLX19990503_235621.gz", "9 km, 20 dB", Moment::ref, 60, 4000},
        {"volumes/KLIX20050828_180149.gz", "1 km, 5 dB", Moment::ref, 150, 2000, 0.4},
        {"volumes/KLOT20220317_000842_V06", "2 km, 12 dB"},
        {"volumes/KOKX20080109_141449.gz", "5 km, 6 dB", Moment::ref, 90, 1000, -0.3},
        {"volumes/KABR20050101_000745.gz", "900 m, 3 dB"},
        {"volumes/KATX20160427_095248_V06.gz", "1 km, 8 dB", Moment::ref, 200, 1000},
        {"volumes/KLBB20160601_150025_V06", "400 m, 10 dB", Moment::ref, 64, 8000, 0, 16},
        {"volumes/Level2_TSTL_20220213_2357.ar2v", "300 m, 4 dB", Moment::ref, 120, 1000},
        {"sequence-kbgm/KBGM20050822_025001.gz", "1 km, 6 dB"},
        {"volumes/KTLX19990503_235621.gz", "2 km, 6 m/s", Moment::vel},
        {"volumes/KLBB20160601_150025_V06", "2 km, 8 m/s", Moment::vel, 120, 1000},
        {"volumes/KDMX20250101_225441_V06", "1 km, 2 dB", Moment::zdr, 120, 2000},
    };
    return list;
}

struct PreparedScene {
    level2::Volume volume;
    SitePosition site;
    GridSpec spec;
    accuracy::Budget budget;
    accuracy::Chain chain;
    std::optional<GridScene> scene;
    std::optional<GridPlan> plan;
};

std::unique_ptr<PreparedScene> prepare(const HonestScene& honest) {
    auto made = std::make_unique<PreparedScene>();
    made->volume = real_volume(honest.file);
    made->site = site_of(made->volume);
    made->spec = square_spec(made->site.latitude_deg, made->site.longitude_deg + honest.east_deg,
                             honest.side, honest.spacing_m);
    made->budget = accuracy::parse_budget(honest.budget).value();
    made->chain = effects_of(honest.moment);
    auto scene = GridScene::make(made->volume, made->site, made->spec, {honest.moment});
    EXPECT_TRUE(scene);
    made->scene.emplace(std::move(*scene));
    auto plan = plan_grid(*made->scene, made->chain, made->budget);
    EXPECT_TRUE(plan) << (plan ? "" : plan.error().message);
    made->plan.emplace(std::move(*plan));
    return made;
}

Grid whole_grid(PreparedScene& prepared, const SceneChoice& choice) {
    const auto geometry = prepared.scene->geometry(choice.frame);
    const GridderOptions options{prepared.scene->options().moment, 0, 2, choice.method, {}};
    auto grid = make_grid(prepared.volume, prepared.site, **geometry, options);
    EXPECT_TRUE(grid);
    return std::move(*grid);
}

CellCircles circles_of(const PreparedScene& prepared) {
    return {prepared.volume, prepared.scene->chosen(), prepared.site, prepared.spec,
            prepared.scene->options().moment};
}

double arc_m(PreparedScene& prepared, int ix, int iy) {
    const auto geometry = prepared.scene->geometry(FrameKind::table);
    return static_cast<double>((*geometry)->row(iy)[static_cast<std::size_t>(ix)].arc_m);
}

// Returns the 99th percentile of the differences of the cells with a value in both grids.
double difference(PreparedScene& prepared, const Grid& a, const Grid& b) {
    std::vector<double> errors;
    CellCircles circles = circles_of(prepared);
    const std::size_t nz = prepared.spec.levels_m.size();
    for (std::size_t cell = 0; cell < a.status.size(); ++cell) {
        if (cell % nz == 0) {
            const auto column = static_cast<int>(cell / nz);
            circles.move_to(arc_m(prepared, column % a.spec.nx, column / a.spec.nx));
        }
        if (a.status[cell] != CellStatus::value || b.status[cell] != CellStatus::value) continue;
        errors.push_back(circles.difference(a.values[cell], b.values[cell], cell % nz));
    }
    const auto summary = accuracy::summarize(errors);
    return summary ? summary->p99 : 0;
}

class Honesty : public ::testing::TestWithParam<std::size_t> {};

TEST_P(Honesty, WhatIsLeftOffIsLessThanTheBudget) {
    STORMCELLAR_NEED_DATA();
    const auto prepared = prepare(scenes()[GetParam()]);
    const accuracy::Plan& plan = prepared->plan->plan;
    ASSERT_TRUE(plan.meets_budget) << plan.shortfall;
    SCOPED_TRACE(plan.description);
    const Grid chosen = whole_grid(*prepared, prepared->plan->choice);
    accuracy::Choice all = plan.choice;
    double position_m = 0;
    for (const accuracy::Decision& decision : plan.decisions) {
        if (decision.on) continue;
        position_m += decision.predicted.position_m;
        const accuracy::Choice one = testing::forced(plan, prepared->chain, decision.effect, true);
        for (std::size_t i = 0; i < all.rungs.size(); ++i)
            all.rungs[i] = std::max(all.rungs[i], one.rungs[i]);
        const Grid with = whole_grid(*prepared, scene_choice(prepared->chain, one));
        EXPECT_LE(difference(*prepared, chosen, with), *prepared->budget.value) << decision.effect;
    }
    EXPECT_LE(position_m, *prepared->budget.position_m);
    const Grid with_all = whole_grid(*prepared, scene_choice(prepared->chain, all));
    EXPECT_LE(difference(*prepared, chosen, with_all), *prepared->budget.value)
        << "with all effects on that the plan left off";
}

// In the whole grid, at most one cell in a hundred may be off by more than the budget. A sample of
// the grid may contain a larger share of such cells.
TEST_P(Honesty, TheGridIsWithinTheBudgetOfTheOracle) {
    STORMCELLAR_NEED_DATA();
    const HonestScene& honest = scenes()[GetParam()];
    const auto prepared = prepare(honest);
    ASSERT_TRUE(prepared->plan->plan.meets_budget);
    const Grid chosen = whole_grid(*prepared, prepared->plan->choice);
    accuracy::Choice exact;
    for (const accuracy::Step& step : prepared->chain.steps)
        exact.rungs.push_back(step.effects.size());
    const OracleSetting setting{prepared->scene->options().moment,
                                beam_width_of(prepared->site.icao),
                                is_tdwr(prepared->site.icao),
                                scene_choice(prepared->chain, exact).method,
                                {}};
    std::vector<ColumnSample::Drawn> columns = prepared->scene->draw(3000, 77).columns;
    std::mt19937 random(5);
    std::shuffle(columns.begin(), columns.end(), random);
    CellCircles circles = circles_of(*prepared);
    int compared = 0;
    int exceeding = 0;
    int used = 0;
    for (const ColumnSample::Drawn& column : columns) {
        const auto first = chosen.status.begin() +
                           static_cast<std::ptrdiff_t>(chosen.spec.index(column.ix, column.iy, 0));
        if (std::find(first, first + chosen.spec.nz(), CellStatus::value) ==
            first + chosen.spec.nz()) {
            continue;
        }
        if (++used > honest.columns / testing::slow_down) break;
        circles.move_to(arc_m(*prepared, column.ix, column.iy));
        const OracleColumn oracle(prepared->volume, prepared->scene->chosen(), setting,
                                  prepared->site, prepared->spec, column.ix, column.iy);
        for (std::size_t level = 0; level < prepared->spec.levels_m.size(); ++level) {
            const std::size_t cell =
                prepared->spec.index(column.ix, column.iy, static_cast<int>(level));
            if (chosen.status[cell] != CellStatus::value) continue;
            const OracleCell exact_cell = oracle.cell(level);
            if (exact_cell.status != CellStatus::value || exact_cell.wide_on_circle) continue;
            ++compared;
            const double error = circles.difference(chosen.values[cell],
                                                    static_cast<float>(exact_cell.value), level);
            if (std::abs(error) > *prepared->budget.value + 0.1) ++exceeding;
        }
    }
    EXPECT_GT(compared, 20 / testing::slow_down);
    // The cells of a column are off together, so allow three times the share, plus six cells.
    EXPECT_LE(exceeding, 0.03 * compared + 6) << "of " << compared;
}

INSTANTIATE_TEST_SUITE_P(Scenes, Honesty, ::testing::Range<std::size_t>(0, 14));

TEST(Honesty, EveryEffectThatIsTurnedOnMattersInSomeScene) {
    STORMCELLAR_NEED_DATA();
    std::map<std::string, double> greatest_part;
    std::map<std::string, bool> ever_on_for_a_reason;
    for (const HonestScene& honest : scenes()) {
        const auto prepared = prepare(honest);
        const accuracy::Plan& plan = prepared->plan->plan;
        const Grid chosen = whole_grid(*prepared, prepared->plan->choice);
        for (const accuracy::Decision& decision : plan.decisions) {
            // Skip effects that are on because they cost nothing, or because they are part of the
            // most accurate choice.
            const bool called_for = decision.reason.starts_with("without it") ||
                                    accuracy::is_unbounded(decision.predicted);
            if (!decision.on || !called_for) continue;
            ever_on_for_a_reason[decision.effect] = true;
            const accuracy::Choice without =
                testing::forced(plan, prepared->chain, decision.effect, false);
            const double change = difference(
                *prepared, chosen, whole_grid(*prepared, scene_choice(prepared->chain, without)));
            const double part =
                std::max(change / *prepared->budget.value,
                         decision.predicted.position_m / *prepared->budget.position_m);
            greatest_part[decision.effect] = std::max(greatest_part[decision.effect], part);
        }
    }
    for (const auto& [effect, ignored] : ever_on_for_a_reason) {
        EXPECT_GT(greatest_part[effect], stated_part) << effect;
    }
    for (const char* effect :
         {"refraction", "antenna_jitter", "column_interpolation", "horizontal_interpolation",
          "beam_width", "cell_size", "velocity_folding"}) {
        EXPECT_TRUE(ever_on_for_a_reason[effect]) << effect << " is on in no scene for its size";
    }
}

}  // namespace
}  // namespace stormcellar::grid
