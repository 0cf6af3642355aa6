// cli/picture/look_costs.h -- what the defaults of a picture cost beside its plan: smooth colors
// and the view that is fitted to the echo. They say what is shown and not how exact it is, so that
// no tolerance turns them off; `frame --explain` has them below the plan.
#pragma once

#include <string>

#include "stormcellar/grid/brick_view.h"
#include "stormcellar/render/scene.h"

namespace stormcellar::cli {

// Draws the volume with its own table and with the classes of its moment, by turns, and compares
// the two. `fit_s` is the time that it took to fit the view; 0: it was not fitted. Returns two
// sentences, each on a line of its own.
[[nodiscard]] std::string look_costs(const grid::BrickView& view, const render::Scene& scene,
                                     double fit_s, int threads);

}  // namespace stormcellar::cli
