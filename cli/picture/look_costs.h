// cli/picture/look_costs.h -- measures the time that two defaults of a picture cost: smooth colors,
// and the view fitted to the echo. Both affect appearance, not accuracy, so no plan chooses them;
// `frame --explain` prints their costs below the plan.
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
