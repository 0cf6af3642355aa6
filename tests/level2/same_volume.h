// tests/level2/same_volume.h -- finds the first difference between two decoded files.
#pragma once

#include <string>

#include "stormcellar/level2/decode.h"
#include "stormcellar/level2/volume_difference.h"

namespace stormcellar::level2 {

// Returns the first difference between the volumes (volume_difference.h), or between the counts and
// texts of the reports. Returns an empty text if there is no difference. Ignores the time taken.
[[nodiscard]] std::string difference(const Decoded& a, const Decoded& b);

}  // namespace stormcellar::level2
