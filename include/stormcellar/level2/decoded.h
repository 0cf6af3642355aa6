// stormcellar/level2/decoded.h -- a volume, and what its decoder has to say of it.
#pragma once

#include "stormcellar/level2/decode_report.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::level2 {

struct Decoded {
    Volume volume;
    DecodeReport report;
};

}  // namespace stormcellar::level2
