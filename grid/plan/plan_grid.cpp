#include <algorithm>
#include <cmath>
#include <limits>

#include "accuracy/governor.h"
#include "grid/plan/grid_cost.h"
#include "grid/plan/grid_effects.h"
#include "grid/plan/position_error.h"
#include "stormcellar/accuracy/candidate.h"

namespace stormcellar::grid {
namespace {

PositionScene position_scene(const GridScene& scene) {
    return {scene.volume(),          scene.site(),          scene.spec(), scene.chosen(),
            scene.options().profile, scene.options().moment};
}

// Returns true if velocities differ by more than the smallest Nyquist velocity, so that some may be
// on the far side of a fold.
bool may_fold(const GridScene& scene) {
    float least = std::numeric_limits<float>::max();
    float most = std::numeric_limits<float>::lowest();
    float nyquist = std::numeric_limits<float>::max();
    const Grid& base = scene.base();
    for (std::size_t cell = 0; cell < base.status.size(); ++cell) {
        if (base.status[cell] != CellStatus::value) continue;
        least = std::min(least, base.values[cell]);
        most = std::max(most, base.values[cell]);
    }
    for (const ChosenSweep& sweep : scene.chosen()) {
        for (const level2::Radial& radial : scene.volume().sweeps[sweep.sweep_index].radials)
            nyquist = std::min(nyquist, radial.nyquist_mps);
    }
    return most > least && most - least > nyquist;
}

// Predicts the sizes of one step's effects from its rungs. The other steps are exact.
Status predict_step(GridScene& scene, const ColumnSample& sample, const SampledCells& exact,
                    std::size_t index, accuracy::Chain& chain) {
    accuracy::Step& step = chain.steps[index];
    const bool centered = is_centered_at(scene.site(), scene.spec());
    const accuracy::Choice top = reference_choice(chain);
    SampledCells above = exact;
    for (std::size_t k = top.rungs[index]; k > 0; --k) {
        accuracy::Effect& effect = step.effects[k - 1];
        if (step.name == step::frame && centered) continue;
        const accuracy::Choice lower = accuracy::with_rung(top, index, k - 1);
        auto below = scene.evaluate(scene_choice(chain, lower), sample);
        if (!below) return pass_on(below);
        effect.predicted.value = scene.compare(*below, above, sample).p99_estimate();
        above = std::move(*below);
    }
    for (accuracy::Effect& effect : step.effects) {
        effect.predicted.position_m = effect_position_m(position_scene(scene), effect.name);
        effect.evidence = accuracy::Evidence::sample;
        // If the grid is about its own site, every rung of the frame gives the same grid.
        if (step.name == step::frame && centered)
            effect.evidence = accuracy::Evidence::proven_bound;
        if (effect.name == "exact_geodesic") effect.evidence = accuracy::Evidence::proven_bound;
        if (effect.name == "velocity_folding" && may_fold(scene)) {
            effect.predicted.value = std::numeric_limits<double>::infinity();
        }
    }
    return {};
}

// Returns how many columns give a good bound of the 99th percentile. If each of 900 columns holds
// as many errors as a column can, the bound is just the greatest error (accuracy/quantile_bound.h);
// three times as many columns give a good bound. If columns hold fewer errors, more columns are
// needed, in proportion. A separate sample shows how many errors columns hold.
Result<std::size_t> columns_for_a_bound(GridScene& scene, const SceneChoice& exact,
                                        const PlanOptions& options) {
    constexpr double full_columns = 3 * 900;
    const ColumnSample sample = scene.draw(options.predict_columns, options.seed + 1);
    const auto cells = scene.evaluate(exact, sample);
    if (!cells) return pass_on(cells);
    const double held = scene.compare(*cells, *cells, sample).mean_load();
    const double most = static_cast<double>(scene.spec().column_count());
    const double needed = held > 0 ? std::min(most, full_columns / held) : most;
    return std::max(options.measure_columns, static_cast<std::size_t>(needed));
}

}  // namespace

Status predict(GridScene& scene, const PlanOptions& options, accuracy::Chain& chain) {
    const ColumnSample sample = scene.draw(options.predict_columns, options.seed);
    const auto exact = scene.evaluate(scene_choice(chain, reference_choice(chain)), sample);
    if (!exact) return pass_on(exact);
    for (std::size_t index = 0; index < chain.steps.size(); ++index) {
        if (auto done = predict_step(scene, sample, *exact, index, chain); !done) return done;
    }
    return predict_costs(scene, chain);
}

Result<GridPlan> plan_grid(GridScene& scene, accuracy::Chain chain,
                           const std::optional<accuracy::Budget>& budget,
                           const PlanOptions& options) {
    if (auto done = predict(scene, options, chain); !done) return pass_on(done);
    // Draw new columns, so that a second sample checks the prediction from the first.
    std::optional<ColumnSample> sample;
    std::optional<SampledCells> exact;
    const auto measure = [&](const accuracy::Choice& choice) -> Result<accuracy::Measured> {
        if (!sample) {
            const SceneChoice all = scene_choice(chain, reference_choice(chain));
            const auto columns = columns_for_a_bound(scene, all, options);
            if (!columns) return pass_on(columns);
            sample = scene.draw(*columns, options.seed + 2);
            auto made = scene.evaluate(all, *sample);
            if (!made) return pass_on(made);
            exact = std::move(*made);
        }
        const auto cells = scene.evaluate(as_measured(scene_choice(chain, choice)), *sample);
        if (!cells) return pass_on(cells);
        const SampledErrors errors = scene.compare(*cells, *exact, *sample);
        accuracy::Measured measured;
        measured.position_m = accuracy::left_off(chain, choice).position_m;
        measured.value = errors.p99_bound();
        measured.status = errors.status;
        return measured;
    };
    const accuracy::Choice by_default =
        default_choice(chain, scene.spec(), scene.options().beam_width_deg);
    auto plan = accuracy::govern_or_default(chain, budget, by_default, measure);
    if (!plan) return pass_on(plan);
    const SceneChoice choice = scene_choice(chain, plan->choice);
    return GridPlan{std::move(*plan), choice};
}

std::string predicted_error(const accuracy::Plan& plan) {
    const double position_m = plan.measured && plan.measured->position_m
                                  ? *plan.measured->position_m
                                  : plan.left_off.position_m;
    const double value =
        plan.measured && plan.measured->value ? *plan.measured->value : plan.left_off.value;
    return fmt::format(
        "position {}, value {} (99th percentile), against the chain's exact form",
        accuracy::format_quantity(accuracy::Quantity::position, position_m, plan.value_unit),
        accuracy::format_quantity(accuracy::Quantity::value, value, plan.value_unit));
}

}  // namespace stormcellar::grid
