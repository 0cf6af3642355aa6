// stormcellar/level2/decoded.h -- a volume, and the report of its decoder.
//
// Threads   Plain data.
#pragma once

#include "stormcellar/level2/decode_report.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::level2 {

struct Decoded {
    Volume volume;
    DecodeReport report;
};

}  // namespace stormcellar::level2
