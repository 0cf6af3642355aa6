// render/frame/hail_text.h -- says how large the error of the hail in a picture may be.
//
// Threads   Pure.
#pragma once

#include <string>

#include "stormcellar/base/result.h"
#include "stormcellar/grid/brick_view.h"
#include "stormcellar/render/scene.h"

namespace stormcellar::render {

// Returns the sensitivity as text, such as "heights 300 m off: MESH 63.1 mm is 52.4 to 74.0 mm".
// Returns an empty text if the product is none of hail or if there is no hail. Errors: as
// largest_hail() (render/products/hail_field.h).
[[nodiscard]] Result<std::string> hail_sensitivity(const grid::BrickView& view, const Scene& scene,
                                                   int threads);

}  // namespace stormcellar::render
