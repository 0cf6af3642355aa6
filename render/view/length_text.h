// render/view/length_text.h -- how labels write lengths on the ground and heights.
//
// Threads   Pure functions.
#pragma once

#include <string>

namespace stormcellar::render {

// Returns "50 km" or "200 m".
[[nodiscard]] std::string distance_text(double metres);

}  // namespace stormcellar::render
