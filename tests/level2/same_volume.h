// tests/level2/same_volume.h -- whether two decoded files are the same to the bit.
#pragma once

#include <string>

#include "stormcellar/level2/decode.h"
#include "stormcellar/level2/volume_difference.h"

namespace stormcellar::level2 {

// Where the volumes first differ (volume_difference.h), or what the reports count and name; the
// time that it took is left out.
[[nodiscard]] std::string difference(const Decoded& a, const Decoded& b);

}  // namespace stormcellar::level2
