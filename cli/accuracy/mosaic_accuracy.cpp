#include "cli/accuracy/mosaic_accuracy.h"

#include "pipeline/plan/mosaic_ladder.h"

namespace stormcellar::cli {

Result<std::vector<accuracy::LadderRow>> ladder_of_mosaic(
    const MosaicSources& sources, const GridRequest& request, const EffectRequest& effects,
    int rounds, const std::function<void(std::size_t done, std::size_t total)>& progress) {
    if (level2::is_circular(request.moment)) {
        return fail(ErrorCode::bad_argument,
                    "{} of several volumes cannot be measured: its values lie on a circle, and "
                    "each radar has its own circle",
                    level2::moment_name(request.moment));
    }
    grid::MosaicOptions overlap;
    overlap.moment = request.moment;
    overlap.overlap = grid::default_overlap(request.moment);
    const auto volumes = sources.scene_volumes();
    auto scene = pipeline::scene_of(volumes, mosaic_request(sources, request, overlap, effects));
    if (!scene) return pass_on(scene);
    return pipeline::run_ladder(*scene, effects.chain, rounds, progress);
}

}  // namespace stormcellar::cli
