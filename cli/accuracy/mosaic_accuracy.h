// cli/accuracy/mosaic_accuracy.h -- `stormcellar accuracy A B ...` for several sites, or for an
// instant between volumes of one site: measures the time and the error of each choice for the steps
// that only a mosaic has (pipeline/plan/mosaic_ladder.h).
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "cli/grid/grid_mosaic.h"
#include "cli/shared/effect_options.h"
#include "stormcellar/accuracy/ladder.h"
#include "stormcellar/base/result.h"

namespace stormcellar::cli {

// Returns the ladder. The volumes overlap by the default rule of the moment. Errors name the file.
[[nodiscard]] Result<std::vector<accuracy::LadderRow>> ladder_of_mosaic(
    const MosaicSources& sources, const GridRequest& request, const EffectRequest& effects,
    int rounds, const std::function<void(std::size_t done, std::size_t total)>& progress);

}  // namespace stormcellar::cli
