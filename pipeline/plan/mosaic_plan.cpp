#include "pipeline/plan/mosaic_plan.h"

#include "accuracy/governor.h"
#include "grid/cells/compare_bricks.h"
#include "stormcellar/accuracy/candidate.h"
#include "stormcellar/grid/gridder.h"

namespace stormcellar::pipeline {
namespace {

accuracy::Plan default_plan(const MosaicScene& scene, const accuracy::Chain& chain) {
    accuracy::Candidate candidate;
    candidate.choice = default_mosaic_choice(
        chain, scene.domain(), grid::beam_width_of(scene.volumes().front().site.icao));
    candidate.left_off = accuracy::left_off(chain, candidate.choice);
    candidate.cost_s = accuracy::cost_s(chain, candidate.choice);
    return accuracy::make_plan(chain, {}, candidate, accuracy::Outcome::met);
}

}  // namespace

Result<MosaicPlan> plan_mosaic(MosaicScene& scene, accuracy::Chain chain,
                               const std::optional<accuracy::Budget>& budget,
                               const grid::PlanOptions& options) {
    if (auto done = predict(scene, options, chain); !done) return pass_on(done);
    if (!budget) {
        accuracy::Plan plan = default_plan(scene, chain);
        const MosaicChoice choice = mosaic_choice(chain, plan.choice);
        return MosaicPlan{std::move(plan), choice};
    }
    std::optional<MosaicFrame> exact;
    const auto measure = [&](const accuracy::Choice& choice) -> Result<accuracy::Measured> {
        if (!exact) {
            auto made = scene.frame(mosaic_choice(chain, exact_mosaic_choice(chain)));
            if (!made) return pass_on(made);
            exact = std::move(*made);
        }
        MosaicChoice rungs = mosaic_choice(chain, choice);
        if (rungs.gridding.frame == grid::FrameKind::geodesic) {
            rungs.gridding.frame = grid::FrameKind::table;
        }
        const auto frame = scene.frame(rungs);
        if (!frame) return pass_on(frame);
        const auto found = grid::compare_bricks(
            frame->mosaic.cells.view(), exact->mosaic.cells.view(), scene.options().frame.threads);
        if (!found) return pass_on(found);
        const auto summary = found->summary();
        accuracy::Measured measured;
        measured.position_m = accuracy::left_off(chain, choice).position_m;
        measured.value = summary ? summary->p99 : 0;
        measured.status = found->status;
        return measured;
    };
    auto plan = accuracy::govern(chain, *budget, measure);
    if (!plan) return pass_on(plan);
    const MosaicChoice choice = mosaic_choice(chain, plan->choice);
    return MosaicPlan{std::move(*plan), choice};
}

}  // namespace stormcellar::pipeline
