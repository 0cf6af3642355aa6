#include "grid/plan/grid_effects.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "base/degree.h"
#include "grid/cells/moment_rules.h"

namespace stormcellar::grid {
namespace {

using accuracy::Step;

struct EffectFacts {
    std::string_view step, name, rung, what;
    // The time for 460 x 460 x 32 cells over a convective volume, as a multiple of the time with
    // nearest gates (docs/accuracy.md).
    double effort = 0;
};
constexpr auto effect_facts = std::to_array<EffectFacts>({
    {step::frame, "ellipsoid", "WGS84 table", "The earth is an ellipsoid, not a sphere of 6371 km.",
     0.1},
    {step::frame, "exact_geodesic", "WGS84 geodesic",
     "Each column has its own geodesic, not one from polynomials.", 28},
    {step::beam, "earth_curvature", "4/3 earth",
     "The earth falls away below the beam, which air bends down a little."},
    {step::beam, "refraction", "ray traced",
     "Air bends the beam more or less than over a 4/3 earth, and delays it.", 0.15},
    {step::elevation, "antenna_jitter", "each radial's",
     "Each radial was measured at an elevation of its own.", 0.1},
    {step::interpolation, "column_interpolation", "linear up the column",
     "Between two sweeps a value lies between theirs.", 0.02},
    {step::interpolation, "horizontal_interpolation", "eight-point",
     "Between radials and gates a value lies between theirs.", 4.5},
    {step::interpolation, "beam_width", "beam-weighted",
     "A gate counts as the antenna's pattern does off its axis.", 2.7},
    {step::cell, "cell_size", "area", "A cell is the mean of all gates inside, not a point.", 29},
    {step::circle, "velocity_folding", "on the Nyquist circle",
     "Velocities beyond the Nyquist velocity come back on the other side.", 0.05},
    {step::circle, "phase_folding", "on the circle", "A phase of 360 degrees is 0.", 0.05},
});

// Returns a step with its effects, cheapest first.
Step make_step(std::string_view name, std::string cheapest) {
    Step made{std::string{name}, std::move(cheapest), {}};
    for (const EffectFacts& facts : effect_facts) {
        if (facts.step != name) continue;
        made.effects.push_back(accuracy::make_effect(std::string{facts.name},
                                                     std::string{facts.rung},
                                                     std::string{facts.what}, facts.effort));
    }
    return made;
}

constexpr const char* in_z = "in Z";

Step circle_step(level2::Moment moment) {
    Step made = make_step(step::circle, "as numbers");
    const bool folds = level2::facts_of(moment).circle == level2::Circle::nyquist;
    made.effects = {made.effects[folds ? 0 : 1]};
    return made;
}

}  // namespace

accuracy::Chain effects_of(level2::Moment moment, Averaging averaging) {
    accuracy::Chain chain;
    chain.steps = {
        make_step(step::frame, "sphere"),
        make_step(step::beam, "flat earth"),
        make_step(step::elevation, "one a sweep"),
        make_step(step::interpolation, "nearest"),
        make_step(step::cell, "point"),
        make_step(step::averaging, averaging == Averaging::in_z ? in_z : "in its own unit"),
    };
    if (is_circular(blending_of(moment))) chain.steps.push_back(circle_step(moment));
    chain.value_unit = value_unit_of(moment);
    return chain;
}

SceneChoice scene_choice(const accuracy::Chain& chain, const accuracy::Choice& choice) {
    const auto rung = [&](std::string_view step) { return accuracy::rung_of(chain, choice, step); };
    SceneChoice scene;
    scene.frame = static_cast<FrameKind>(rung(step::frame));
    scene.method.beam = static_cast<BeamKind>(rung(step::beam));
    scene.method.radial_elevations = rung(step::elevation) > 0;
    scene.method.interpolation = static_cast<Interpolation>(rung(step::interpolation));
    scene.method.cell = rung(step::cell) > 0 ? CellExtent::area : CellExtent::point;
    scene.method.averaging = Averaging::in_db;
    scene.method.on_circle = true;
    const auto averaging = accuracy::find_step(chain, step::averaging);
    if (averaging && chain.steps[*averaging].cheapest == in_z) {
        scene.method.averaging = Averaging::in_z;
    }
    if (accuracy::find_step(chain, step::circle)) scene.method.on_circle = rung(step::circle) > 0;
    return scene;
}

accuracy::Choice reference_choice(const accuracy::Chain& chain) {
    accuracy::Choice choice;
    for (const Step& step : chain.steps)
        choice.rungs.push_back(step.name == step::frame ? 1 : step.effects.size());
    return choice;
}

SceneChoice as_measured(SceneChoice choice) {
    if (choice.frame == FrameKind::geodesic) choice.frame = FrameKind::table;
    return choice;
}

double joint_effort(Interpolation interpolation, CellExtent cell) {
    if (cell == CellExtent::point) return 0;
    if (interpolation == Interpolation::eight_point) return 25;
    return interpolation == Interpolation::beam_weighted ? 32 : 0;
}

accuracy::Choice usual_choice(const accuracy::Chain& chain) {
    accuracy::Choice choice;
    for (const Step& step : chain.steps) {
        const std::size_t rung =
            step.name == step::cell ? 0 : std::min<std::size_t>(1, step.effects.size());
        const accuracy::RungRange allowed = accuracy::allowed_rungs(step);
        choice.rungs.push_back(std::clamp(rung, allowed.least, allowed.most));
    }
    return choice;
}

accuracy::Choice default_choice(const accuracy::Chain& chain, const GridSpec& spec,
                                double beam_width_deg) {
    accuracy::Choice choice = usual_choice(chain);
    const double beam_m = wide_cells_arc_m * beam_width_deg * degree;
    if (std::max(spec.cell_width_m(), spec.cell_height_m()) <= beam_m) return choice;
    const auto cell = accuracy::find_step(chain, step::cell);
    if (cell) choice.rungs[*cell] = accuracy::allowed_rungs(chain.steps[*cell]).most;
    return choice;
}

accuracy::ValueUnit value_unit_of(level2::Moment moment) {
    return rules_of(moment).value_unit;
}

}  // namespace stormcellar::grid
