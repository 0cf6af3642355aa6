#include "level2/live_sweep.h"

#include "level2/fragment_builder.h"
#include "level2/volume_checks.h"

namespace stormcellar::level2 {

bool is_whole(const Sweep& sweep) {
    if (sweep.radials.empty() || !begins_sweep(sweep.radials.front())) return false;
    const RadialStatus last = status_of(sweep.radials.back());
    const RadialGaps gaps = gaps_of(sweep);
    return (last == RadialStatus::end_of_elevation || last == RadialStatus::end_of_volume) &&
           gaps.missing == 0 && gaps.repeated == 0;
}

}  // namespace stormcellar::level2
