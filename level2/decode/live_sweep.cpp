#include "stormcellar/level2/live_sweep.h"

#include "level2/decode/array_room.h"
#include "level2/decode/fragment_builder.h"
#include "level2/decode/volume_checks.h"

namespace stormcellar::level2 {

std::uint64_t bytes_of(const Sweep& sweep) {
    std::uint64_t bytes = empty_sweep_bytes + sweep.radials.size() * sizeof(Radial);
    for (const SweepMoment& moment : sweep.moments) {
        bytes += moment.codes8.size() + sizeof(std::uint16_t) * moment.codes16.size();
        bytes += empty_kind_bytes + sizeof(std::uint16_t) * moment.gate_counts.size();
    }
    return bytes;
}

bool is_whole(const Sweep& sweep) {
    if (sweep.radials.empty() || !begins_sweep(sweep.radials.front())) return false;
    const RadialGaps gaps = gaps_of(sweep);
    return ends_sweep(sweep.radials.back()) && gaps.missing == 0 && gaps.repeated == 0;
}

}  // namespace stormcellar::level2
