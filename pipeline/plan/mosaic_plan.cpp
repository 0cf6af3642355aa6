#include "pipeline/plan/mosaic_plan.h"

#include "accuracy/governor.h"
#include "grid/cells/compare_bricks.h"
#include "stormcellar/accuracy/candidate.h"
#include "stormcellar/grid/gridder.h"

namespace stormcellar::pipeline {
Result<MosaicPlan> plan_mosaic(MosaicScene& scene, accuracy::Chain chain,
                               const std::optional<accuracy::Budget>& budget,
                               const grid::PlanOptions& options) {
    if (auto done = predict(scene, options, chain); !done) return pass_on(done);
    std::optional<MosaicFrame> exact;
    const auto measure = [&](const accuracy::Choice& choice) -> Result<accuracy::Measured> {
        if (!exact) {
            auto made = scene.frame(mosaic_choice(chain, grid::reference_choice(chain)));
            if (!made) return pass_on(made);
            exact = std::move(*made);
        }
        MosaicChoice rungs = mosaic_choice(chain, choice);
        rungs.gridding = grid::as_measured(rungs.gridding);
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
    const accuracy::Choice by_default = default_mosaic_choice(
        chain, scene.domain(), grid::beam_width_of(scene.volumes().front().site.icao));
    auto plan = accuracy::govern_or_default(chain, budget, by_default, measure);
    if (!plan) return pass_on(plan);
    const MosaicChoice choice = mosaic_choice(chain, plan->choice);
    return MosaicPlan{std::move(*plan), choice};
}

}  // namespace stormcellar::pipeline
