// render/image/round_step.h -- the distance between the numbers of an axis.
//
// Threads   A pure function.
#pragma once

namespace stormcellar::render {

// Returns 1, 2 or 5 times a power of ten, such that the range (above 0) has at most `most_steps`
// steps.
[[nodiscard]] double round_step(double range, int most_steps);

}  // namespace stormcellar::render
