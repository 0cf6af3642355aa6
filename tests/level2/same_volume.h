// tests/level2/same_volume.h -- whether two decoded files are the same to the bit.
#pragma once

#include <string>

#include "stormcellar/level2/decode.h"
#include "stormcellar/level2/volume_difference.h"

namespace stormcellar::level2 {

// Returns where the volumes first differ (volume_difference.h), or where the counts and texts of
// the reports differ; the time taken is ignored.
[[nodiscard]] std::string difference(const Decoded& a, const Decoded& b);

}  // namespace stormcellar::level2
