#include <algorithm>
#include <cmath>
#include <vector>

#include "accuracy/timing.h"
#include "base/parallel.h"
#include "grid/cells/compare_bricks.h"
#include "grid/plan/grid_scene.h"
#include "pipeline/plan/mosaic_plan.h"

namespace stormcellar::pipeline {
namespace {

// Times of making a site's grid between two of its volumes, and of merging. The unit is the time of
// gridding one volume with nearest gates (grid/plan/grid_effects.cpp; docs/accuracy.md).
constexpr double blend_effort = 2.5;
constexpr double motion_effort = 4.5;
constexpr double sweep_times_effort = 3;
constexpr double overlap_effort = 0.2;
constexpr double fine_codes_effort = 0.2;

// Returns the step of merging with this name. The chain of a mosaic has all steps of merging.
accuracy::Step& step_named(accuracy::Chain& chain, std::string_view name) {
    return chain.steps[accuracy::find_step(chain, name).value()];
}

Result<double> p99_between(const MosaicFrame& a, const MosaicFrame& b, int threads) {
    const auto found = grid::compare_bricks(a.mosaic.cells.view(), b.mosaic.cells.view(), threads);
    if (!found) return pass_on(found);
    const auto summary = found->summary();
    return summary ? summary->p99 : 0;
}

// The sizes for the steps of gridding. They are predicted for each volume separately.
class GriddingSizes {
  public:
    GriddingSizes(MosaicScene& scene, const grid::PlanOptions& options,
                  const accuracy::Chain& chain)
        : scene_(scene), options_(options) {
        const MosaicSceneOptions& made_by = scene.options();
        moment_ = made_by.partial.gridder.moment;
        gridding_.value_unit = chain.value_unit;
        for (const accuracy::Step& step : chain.steps) {
            if (!is_of_merging(step)) gridding_.steps.push_back(step);
        }
    }

    [[nodiscard]] Status predict_into(accuracy::Chain& chain) {
        const std::size_t count = scene_.volumes().size();
        std::vector<std::optional<Result<accuracy::Chain>>> made(count);
        for_each_piece(static_cast<int>(count), scene_.options().frame.threads, [&](int piece) {
            const auto at = static_cast<std::size_t>(piece);
            made[at] = predict_one(scene_.volumes()[at]);
        });
        for (std::size_t at = 0; at < count; ++at) {
            const Result<accuracy::Chain>& one = *made[at];
            if (!one) {
                return fail(one.error().code, "{}: {}", scene_.volumes()[at].file,
                            one.error().message);
            }
            add(*one, at == 0, chain);
        }
        share_costs(chain);
        return {};
    }

  private:
    [[nodiscard]] Result<accuracy::Chain> predict_one(const SceneVolume& source) const {
        const grid::GridderOptions& gridder = scene_.options().partial.gridder;
        const auto window =
            grid::site_window(scene_.domain(), source.site, scene_.options().partial.reach_m);
        if (!window) return fail(ErrorCode::bad_argument, "the site sees nothing of the grid");
        grid::SceneOptions options;
        options.moment = moment_;
        options.beam_width_deg = gridder.beam_width_deg;
        if (gridder.profile) options.profile = *gridder.profile;
        auto scene = grid::GridScene::make(*source.volume, source.site,
                                           grid::window_spec(scene_.domain(), *window), options);
        if (!scene) return pass_on(scene);
        accuracy::Chain chain = gridding_;
        if (auto done = grid::predict(*scene, options_, chain); !done) return pass_on(done);
        return chain;
    }

    // Adds the prediction for one volume. The size is the largest of all volumes, and times are
    // added up.
    static void add(const accuracy::Chain& one, bool first, accuracy::Chain& all) {
        for (std::size_t i = 0; i < one.steps.size(); ++i) {
            for (std::size_t k = 0; k < one.steps[i].effects.size(); ++k) {
                const accuracy::Effect& from = one.steps[i].effects[k];
                accuracy::Effect& to = all.steps[i].effects[k];
                to.evidence = from.evidence;
                to.predicted.position_m =
                    std::max(to.predicted.position_m, from.predicted.position_m);
                to.predicted.value = std::max(to.predicted.value, from.predicted.value);
                to.cost_s += from.cost_s;
            }
        }
        all.cheapest_cost_s += one.cheapest_cost_s;
        if (first) {
            all.joint_costs = one.joint_costs;
            return;
        }
        for (std::size_t pair = 0; pair < all.joint_costs.size(); ++pair)
            all.joint_costs[pair].cost_s += one.joint_costs[pair].cost_s;
    }

    // Divides the costs by the number of threads, because each is predicted for one thread.
    void share_costs(accuracy::Chain& chain) const {
        const double threads = std::max(1, scene_.options().partial.gridder.threads);
        for (accuracy::Step& step : chain.steps) {
            for (accuracy::Effect& effect : step.effects)
                effect.cost_s /= threads;
        }
        for (accuracy::JointCost& joint : chain.joint_costs)
            joint.cost_s /= threads;
        chain.cheapest_cost_s /= threads;
    }

    MosaicScene& scene_;
    const grid::PlanOptions& options_;
    level2::Moment moment_ = level2::Moment::ref;
    accuracy::Chain gridding_;
};

struct TimedFrame {
    MosaicFrame frame;
    double seconds = 0;  // not counting gridding
};

Result<TimedFrame> timed_frame(MosaicScene& scene, const MosaicChoice& choice) {
    const auto gridded = scene.partials(choice);
    if (!gridded) return pass_on(gridded);
    const double start_s = scene.now_s();
    auto frame = scene.frame(choice);
    if (!frame) return pass_on(frame);
    return TimedFrame{std::move(*frame), scene.now_s() - start_s};
}

// Measures one step, from its exact rung down to the cheapest. Every other step of merging is
// exact. All frames use `gridding` and fine codes.
Status predict_step(MosaicScene& scene, const TimedFrame& exact, const grid::SceneChoice& gridding,
                    std::string_view name, accuracy::Chain& chain) {
    const std::size_t index = accuracy::find_step(chain, name).value();
    accuracy::Step& step = chain.steps[index];
    const accuracy::Choice top = grid::reference_choice(chain);
    const TimedFrame* above = &exact;
    std::optional<TimedFrame> kept;
    for (std::size_t k = step.effects.size(); k > 0; --k) {
        MosaicChoice choice = mosaic_choice(chain, accuracy::with_rung(top, index, k - 1));
        choice.gridding = gridding;
        auto below = timed_frame(scene, choice);
        if (!below) return pass_on(below);
        const auto p99 = p99_between(below->frame, above->frame, scene.options().frame.threads);
        if (!p99) return pass_on(p99);
        accuracy::Effect& effect = step.effects[k - 1];
        effect.evidence = accuracy::Evidence::sample;
        effect.predicted.value = *p99;
        effect.cost_s = std::max(0.0, above->seconds - below->seconds);
        kept = std::move(*below);
        above = &*kept;
    }
    return {};
}

// Sets the size of the effect of codes. Each rounding moves a value by at most half a step, and a
// mean of values by no more than that.
void set_codes(const MosaicScene& scene, const TimedFrame& fine, const TimedFrame& coarse,
               accuracy::Chain& chain) {
    const level2::Moment moment = scene.options().partial.gridder.moment;
    const double steps = static_cast<double>(quantization_of(moment, false).step) +
                         static_cast<double>(quantization_of(moment, true).step);
    const int roundings =
        1 + (scene.pair_count() > 0 ? 1 : 0) + (scene.brackets().size() > 1 ? 1 : 0);
    accuracy::Effect& effect = step_named(chain, step::codes).effects[0];
    effect.evidence = accuracy::Evidence::proven_bound;
    effect.predicted.value = roundings * steps / 2;
    effect.cost_s = std::max(0.0, fine.seconds - coarse.seconds);
}

void set_efforts(const MosaicScene& scene, accuracy::Chain& chain) {
    const double pairs =
        static_cast<double>(scene.pair_count()) / static_cast<double>(scene.volumes().size());
    accuracy::Step& time = step_named(chain, step::time);
    time.effects[0].effort = blend_effort * pairs;
    time.effects[1].effort = motion_effort * pairs;
    step_named(chain, step::sweeps).effects[0].effort = sweep_times_effort * pairs;
    accuracy::Step& overlap = step_named(chain, step::overlap);
    if (!overlap.effects.empty() && scene.brackets().size() > 1) {
        overlap.effects[0].effort = overlap_effort;
    }
    step_named(chain, step::codes).effects[0].effort = fine_codes_effort;
}

Status predict_merging(MosaicScene& scene, accuracy::Chain& chain) {
    MosaicChoice top = mosaic_choice(chain, grid::reference_choice(chain));
    top.gridding = scene.default_choice().gridding;
    const auto fine = timed_frame(scene, top);
    if (!fine) return pass_on(fine);
    for (const std::string_view name : {step::time, step::sweeps, step::overlap}) {
        if (auto done = predict_step(scene, *fine, top.gridding, name, chain); !done) return done;
    }
    MosaicChoice coarse = top;
    coarse.fine_codes = false;
    const auto rounded = timed_frame(scene, coarse);
    if (!rounded) return pass_on(rounded);
    set_codes(scene, *fine, *rounded, chain);
    const Displacements moved = displacements(scene);
    step_named(chain, step::time).effects[1].predicted.position_m = moved.to_instant_m;
    step_named(chain, step::sweeps).effects[0].predicted.position_m = moved.within_volume_m;
    step_named(chain, step::time).effects[1].cost_s += scene.motion_seconds();
    set_efforts(scene, chain);
    // Add the time of the cheapest frame, not counting its gridding.
    MosaicChoice cheapest = coarse;
    cheapest.time = grid::TimeMethod::nearest;
    cheapest.sweep_times = false;
    cheapest.mixes_sites = false;
    const auto least = timed_frame(scene, cheapest);
    if (!least) return pass_on(least);
    chain.cheapest_cost_s += least->seconds;
    return {};
}

}  // namespace

Displacements displacements(const MosaicScene& scene) {
    Displacements moved;
    for (const Bracket& bracket : scene.brackets()) {
        if (!bracket.before || !bracket.after) continue;
        for (const std::size_t end : {*bracket.before, *bracket.after}) {
            const auto known = scene.motions().find(scene.volumes()[end].site.icao);
            if (known == scene.motions().end() || !known->second) continue;
            const grid::CellMotion greatest = known->second->greatest();
            const double speed_mps =
                std::hypot(static_cast<double>(greatest.x) * scene.domain().cell_width_m(),
                           static_cast<double>(greatest.y) * scene.domain().cell_height_m());
            const MosaicScene::Times& times = scene.times()[end];
            const double half_s = seconds_between(times.start, times.end) / 2;
            const double away_s = seconds_between(times.start, scene.instant()) - half_s;
            moved.to_instant_m = std::max(moved.to_instant_m, speed_mps * std::abs(away_s));
            moved.within_volume_m = std::max(moved.within_volume_m, speed_mps * half_s);
        }
    }
    return moved;
}

Status predict(MosaicScene& scene, const grid::PlanOptions& options, accuracy::Chain& chain) {
    const level2::Moment moment = scene.options().partial.gridder.moment;
    if (level2::is_circular(moment)) {
        return fail(ErrorCode::bad_argument,
                    "a plan cannot be made for {} of several volumes: its values lie on a circle, "
                    "and each radar has its own",
                    level2::moment_name(moment));
    }
    if (auto done = GriddingSizes(scene, options, chain).predict_into(chain); !done) return done;
    return predict_merging(scene, chain);
}

}  // namespace stormcellar::pipeline
