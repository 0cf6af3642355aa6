// cli/picture/look_costs.h -- measures the time that two defaults of a picture take: smooth colors,
// and the view fitted to the echo. Both change how a picture looks, not how accurate it is, so no
// plan chooses them; `frame --explain` prints their times below the plan.
#pragma once

#include <string>

#include "stormcellar/grid/brick_view.h"
#include "stormcellar/render/scene.h"

namespace stormcellar::cli {

// Draws the volume alternately with its own color table and with the color classes of its moment,
// and compares the times. `fit_s` is the time for fitting the view, or 0 if the view was not
// fitted. Returns two sentences, each on its own line.
[[nodiscard]] std::string look_costs(const grid::BrickView& view, const render::Scene& scene,
                                     double fit_s, int threads);

}  // namespace stormcellar::cli
