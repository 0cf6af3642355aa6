// render/image/round_step.h -- how far apart the numbers of an axis are.
#pragma once

namespace stormcellar::render {

// 1, 2 or 5 times a power of ten: so that a range (above 0) has at most so many steps.
[[nodiscard]] double round_step(double range, int most_steps);

}  // namespace stormcellar::render
