// render/image/round_step.h -- chooses the distance between the numbers of an axis.
//
// Threads   A pure function.
#pragma once

namespace stormcellar::render {

// Returns 1, 2 or 5 times a power of ten. The range, which must be above 0, then has at most
// `most_steps` steps.
[[nodiscard]] double round_step(double range, int most_steps);

}  // namespace stormcellar::render
