#include "level2/live_sweep.h"

#include "level2/fragment_builder.h"
#include "level2/volume_checks.h"

namespace stormcellar::level2 {

bool is_whole(const Sweep& sweep) {
    if (sweep.radials.empty() || !begins_sweep(sweep.radials.front())) return false;
    const RadialGaps gaps = gaps_of(sweep);
    return ends_sweep(sweep.radials.back()) && gaps.missing == 0 && gaps.repeated == 0;
}

}  // namespace stormcellar::level2
