// Tests the samples of a scene, and the plans that are made from them.
#include <cmath>

#include <gtest/gtest.h>

#include "grid/plan/grid_effects.h"
#include "grid/plan/grid_scene.h"
#include "stormcellar/grid/gridder.h"
#include "tests/grid/real_volume.h"
#include "tests/grid/square_spec.h"
#include "tests/grid/volume_maker.h"

namespace stormcellar::grid {
namespace {

const SitePosition ktlx{"KTLX", 35.3333, -97.2778, 389};

// Returns a volume with echo in its eastern half that changes from gate to gate.
level2::Volume half_volume() {
    SweepPlan plan;
    plan.code = [](int radial, int gate) {
        return radial < 180 ? static_cast<std::uint16_t>(90 + (radial * 7 + gate * 3) % 60)
                            : below_threshold;
    };
    return make_volume(plans_at({0.5, 1.5, 2.5, 3.5, 4.5}, plan));
}

GridSpec spec_of(int side, double spacing_m) {
    return square_spec(ktlx.latitude_deg, ktlx.longitude_deg, side, spacing_m);
}

TEST(GridScene, ACensusHoldsEveryColumnWithEcho) {
    const level2::Volume volume = half_volume();
    const auto scene = GridScene::make(volume, ktlx, spec_of(40, 5000), {});
    ASSERT_TRUE(scene);
    const ColumnSample sample = scene->draw(5000, 1);
    EXPECT_TRUE(sample.is_census);
    EXPECT_EQ(sample.columns.size(), scene->columns_with_echo());
    EXPECT_GE(sample.columns.size(), 40U * 20U - 40U);
    EXPECT_LE(sample.columns.size(), 40U * 23U) << "columns of the east, and two beyond";
}

TEST(GridScene, DrawsInProportionToWhatColumnsHold) {
    const level2::Volume volume = half_volume();
    auto scene = GridScene::make(volume, ktlx, spec_of(200, 2000), {});
    ASSERT_TRUE(scene);
    const ColumnSample sample = scene->draw(3000, 1);
    ASSERT_FALSE(sample.is_census);
    int draws = 0;
    double columns = 0;
    for (const auto& column : sample.columns) {
        draws += column.draws;
        columns += column.draws * column.weight;
        EXPECT_GE(column.ix, 98) << "there is no echo in the west";
    }
    EXPECT_EQ(draws, 3000);
    // The sum of draws * weight estimates the number of columns, up to a common factor.
    EXPECT_GT(columns, 0);
    const ColumnSample again = scene->draw(3000, 1);
    EXPECT_EQ(again.columns.size(), sample.columns.size())
        << "the same seed draws the same columns";
}

TEST(GridScene, SampledCellsAreThoseOfTheWholeGrid) {
    STORMCELLAR_NEED_DATA();
    const level2::Volume volume = real_volume("volumes/KTLX19990503_235621.gz");
    const SitePosition here = site_of(volume);
    GridSpec spec = square_spec(here.latitude_deg + 0.2, here.longitude_deg, 150, 2500);
    auto scene = GridScene::make(volume, here, spec, {});
    ASSERT_TRUE(scene);
    const ColumnSample sample = scene->draw(500, 4);
    for (const Interpolation interpolation :
         {Interpolation::nearest, Interpolation::linear, Interpolation::eight_point,
          Interpolation::beam_weighted}) {
        for (const CellExtent cell : {CellExtent::point, CellExtent::area}) {
            for (const FrameKind frame : {FrameKind::sphere, FrameKind::table}) {
                SceneChoice choice;
                choice.frame = frame;
                choice.method.interpolation = interpolation;
                choice.method.cell = cell;
                choice.method.beam = BeamKind::traced;
                const auto cells = scene->evaluate(choice, sample);
                ASSERT_TRUE(cells);
                const auto whole = make_grid(volume, here, **scene->geometry(frame),
                                             {level2::Moment::ref, 0, 1, choice.method, {}});
                ASSERT_TRUE(whole);
                std::size_t at = 0;
                for (const auto& column : sample.columns) {
                    for (int iz = 0; iz < spec.nz(); ++iz, ++at) {
                        const std::size_t index = spec.index(column.ix, column.iy, iz);
                        ASSERT_EQ(cells->status[at], whole->status[index]);
                        if (whole->status[index] != CellStatus::value) continue;
                        ASSERT_EQ(cells->values[at], whole->values[index]);
                    }
                }
            }
        }
    }
}

TEST(Effects, EveryMomentHasAChainThatIsValid) {
    for (const level2::Moment moment : level2::all_moments) {
        const accuracy::Chain chain = effects_of(moment);
        EXPECT_TRUE(accuracy::validate(chain));
        accuracy::Choice exact;
        for (const accuracy::Step& step : chain.steps)
            exact.rungs.push_back(step.effects.size());
        const SceneChoice choice = scene_choice(chain, exact);
        EXPECT_EQ(choice.frame, FrameKind::geodesic);
        EXPECT_EQ(choice.method.beam, BeamKind::traced);
        EXPECT_EQ(choice.method.cell, CellExtent::area);
        EXPECT_EQ(choice.method.averaging, Averaging::in_db);
        EXPECT_TRUE(choice.method.on_circle);
    }
    const accuracy::Chain in_z = effects_of(level2::Moment::ref, Averaging::in_z);
    accuracy::Choice cheapest;
    cheapest.rungs.resize(in_z.steps.size());
    EXPECT_EQ(scene_choice(in_z, cheapest).method.averaging, Averaging::in_z);
}

TEST(Effects, TheDefaultIsTheGriddersOwn) {
    const accuracy::Chain chain = effects_of(level2::Moment::ref);
    const SceneChoice usual = scene_choice(chain, default_choice(chain, spec_of(460, 1000), 0.95));
    EXPECT_EQ(usual, SceneChoice{});
    const SceneChoice coarse = scene_choice(chain, default_choice(chain, spec_of(115, 4000), 0.95));
    EXPECT_EQ(coarse.method.cell, CellExtent::area) << "4 km cells are wider than the beam";
    const SceneChoice part = scene_choice(chain, default_choice(chain, spec_of(50, 1000), 0.95));
    EXPECT_EQ(part, usual) << "the extent of the grid does not matter";
}

TEST(Effects, ErrorsAreInTheUnitOfTheMoment) {
    EXPECT_EQ(value_unit_of(level2::Moment::ref), accuracy::ValueUnit::db);
    EXPECT_EQ(value_unit_of(level2::Moment::vel), accuracy::ValueUnit::mps);
    EXPECT_EQ(value_unit_of(level2::Moment::phi), accuracy::ValueUnit::degree);
    EXPECT_EQ(value_unit_of(level2::Moment::rho), accuracy::ValueUnit::ratio);
}

GridPlan planned_for(const level2::Volume& volume, const GridSpec& spec, const char* budget) {
    auto scene = GridScene::make(volume, ktlx, spec, {}).value();
    return plan_grid(scene, effects_of(level2::Moment::ref), accuracy::parse_budget(budget).value())
        .value();
}

// With thin echo, a column has values in few of the cells that may hold one, so the sample needs
// many columns before it gives a bound.
TEST(Plan, ThinEchoIsMeasuredUntilThereIsABound) {
    SweepPlan low;
    low.code = [](int radial, int gate) {
        return static_cast<std::uint16_t>(90 + (radial * 7 + gate * 3) % 40);
    };
    SweepPlan empty;
    empty.elevation_deg = 1.5;
    empty.cut = 2;
    empty.code = [](int, int) { return below_threshold; };
    const level2::Volume volume = make_volume({low, empty});
    const GridPlan planned = planned_for(volume, spec_of(300, 1000), "20 km, 60 dB");
    ASSERT_TRUE(planned.plan.meets_budget);
    ASSERT_TRUE(planned.plan.measured);
    EXPECT_TRUE(planned.plan.measured->value) << "the sample was too small";
    EXPECT_EQ(planned.choice.method.interpolation, Interpolation::nearest);
    EXPECT_EQ(planned.choice.method.cell, CellExtent::point);
}

// Without changes from place to place, interpolation matters only at the edge of the echo.
TEST(Plan, AnEvenSkyNeedsNoInterpolation) {
    const level2::Volume volume = make_volume(plans_at({0.5, 1.5, 2.5}));
    const GridPlan planned = planned_for(volume, spec_of(60, 2000), "20 km, 1 dB");
    EXPECT_TRUE(planned.plan.meets_budget);
    // If linear interpolation is measured as no slower than nearest, the plan may choose it.
    EXPECT_LE(planned.choice.method.interpolation, Interpolation::linear);
    EXPECT_EQ(planned.choice.method.cell, CellExtent::point);
    EXPECT_EQ(planned.choice.method.averaging, Averaging::in_db);
}

TEST(Plan, ABudgetOutOfReachNamesTheBest) {
    const level2::Volume volume = half_volume();
    auto scene = GridScene::make(volume, ktlx, spec_of(60, 2000), {});
    ASSERT_TRUE(scene);
    accuracy::Chain chain = effects_of(level2::Moment::ref);
    const std::vector<accuracy::EffectOverride> off = {{"refraction", accuracy::Setting::off}};
    ASSERT_TRUE(accuracy::apply_overrides(chain, off));
    const auto planned = plan_grid(*scene, chain, accuracy::parse_budget("1 m, 1 dB").value());
    ASSERT_TRUE(planned);
    EXPECT_FALSE(planned->plan.meets_budget);
    EXPECT_NE(planned->plan.shortfall.find("set off: refraction"), std::string::npos)
        << planned->plan.shortfall;
}

}  // namespace
}  // namespace stormcellar::grid
