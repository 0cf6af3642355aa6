// tests/level2/same_volume.h -- whether two volumes are the same to the bit.
#pragma once

#include <string>

#include "level2/decode.h"

namespace stormcellar::level2 {

// Where the volumes first differ, as "sweep 3, radial 17"; empty when they do not. Numbers are
// compared as bits, so a NaN equals itself and 0 does not equal -0.
[[nodiscard]] std::string difference(const Volume& a, const Volume& b);

// As above, with what the reports count and name; the time that it took is left out.
[[nodiscard]] std::string difference(const Decoded& a, const Decoded& b);

}  // namespace stormcellar::level2
