// cli/picture/look_costs.h -- measures the costs of a picture's defaults that are not in its plan:
// smooth colors, and the view fitted to the echo. They are a choice of appearance, not of accuracy,
// so no tolerance turns them off; `frame --explain` prints them below the plan.
#pragma once

#include <string>

#include "stormcellar/grid/brick_view.h"
#include "stormcellar/render/scene.h"

namespace stormcellar::cli {

// Draws the volume alternately with its own table and with the classes of its moment, and compares
// the times. `fit_s` is the time for fitting the view; 0 if it was not fitted. Returns two
// sentences, each on its own line.
[[nodiscard]] std::string look_costs(const grid::BrickView& view, const render::Scene& scene,
                                     double fit_s, int threads);

}  // namespace stormcellar::cli
