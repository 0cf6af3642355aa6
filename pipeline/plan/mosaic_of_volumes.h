// pipeline/plan/mosaic_of_volumes.h -- merges decoded volumes of several sites, or of several
// times, into one grid for one instant. The defaults or the accuracy planner decide how.
//
// Thread contract: each call is independent. It starts up to `frame.threads` threads of its own.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pipeline/mosaic/mosaic_scene.h"
#include "stormcellar/accuracy/budget.h"
#include "stormcellar/accuracy/chain.h"
#include "stormcellar/accuracy/plan.h"
#include "stormcellar/base/result.h"
#include "stormcellar/grid/grid.h"

namespace stormcellar::pipeline {

struct MosaicRequest {
    grid::GridSpec domain;
    accuracy::Chain chain;                   // from mosaic_effects_of(), with the requested
                                             // settings
    FrameOptions frame;                      // the choice overrides what the chain decides
    PartialOptions partial;                  // the choice overrides what the chain decides
    std::optional<UtcTime> instant;          // none: instant_of_newest()
    bool is_planned = false;                 // predict the size of each effect for these volumes
    std::optional<accuracy::Budget> budget;  // needs a plan
};

struct MosaicOfVolumes {
    grid::Grid grid;                     // empty if the plan does not meet its budget
    std::optional<accuracy::Plan> plan;  // if one was requested
    double plan_s = 0, grid_s = 0, merge_s = 0;
};

// Grids the volumes and merges them. The notes of the provenance name each volume that was left out
// because its middle is more than `greatest_gap` from the instant. Errors: those of
// make_partials(), make_frame() and plan_mosaic().
[[nodiscard]] Result<MosaicOfVolumes> make_mosaic(const std::vector<SceneVolume>& volumes,
                                                  const MosaicRequest& request);
// Grids the volumes and merges them, like the function above. Several calls share the geometries. A
// plan uses geometries of its own.
[[nodiscard]] Result<MosaicOfVolumes> make_mosaic(const std::vector<SceneVolume>& volumes,
                                                  const MosaicRequest& request,
                                                  GeometryCache& geometries);

// Returns one partial for each volume. Each partial is gridded by the settings of the chain, and
// otherwise by the defaults. Errors: those of make_partials().
[[nodiscard]] Result<std::vector<MadePartial>> grid_volumes(const std::vector<SceneVolume>& volumes,
                                                            const MosaicRequest& request,
                                                            GeometryCache& geometries);

// Returns the scene on which the accuracy planner measures. The volumes must outlive it. Errors:
// those of MosaicScene::make().
[[nodiscard]] Result<MosaicScene> scene_of(const std::vector<SceneVolume>& volumes,
                                           const MosaicRequest& request);

// The capacity of the GeometryCache if the caller passes none.
inline constexpr std::size_t mosaic_geometries = 4;

}  // namespace stormcellar::pipeline
