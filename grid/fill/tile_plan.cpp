#include "grid/fill/tile_plan.h"

#include <algorithm>

namespace stormcellar::grid {
namespace {

// The sweeps from `reach` below a sweep to `reach` above it.
struct Around {
    std::size_t first, last;
};
Around around(std::size_t at, std::size_t count, int reach) {
    const auto by = static_cast<std::size_t>(reach);
    return {at > by ? at - by : 0, std::min(count - 1, at + by)};
}

}  // namespace

void TilePlan::make(std::span<const PolarSweep> sweeps, const std::vector<bool>& adjacent_to_next,
                    const PolarBounds& bounds, const SampleReach& reach) {
    const PolarBounds wider = bounds.widened(reach.azimuth_deg, reach.arc_m);
    uniform_.clear();
    for (const PolarSweep& sweep : sweeps)
        uniform_.push_back(sweep.uniform_status(wider));

    // Drop a sweep if it and all sweeps around it are uniform with the same status, and no lost cut
    // is between them. If all of these are uniform but have different statuses, do not sample the
    // sweep: no value is mixed with its status, so the status needs no detection limit.
    planned_.clear();
    const std::size_t count = sweeps.size();
    for (std::size_t at = 0; at < count; ++at) {
        const auto [first, last] = around(at, count, reach.sweeps);
        bool near_sampled = !reach.in_order;
        bool all_alike = reach.in_order && at > 0 && at + 1 < count;
        for (std::size_t other = first; other <= last; ++other) {
            near_sampled = near_sampled || !uniform_[other];
            all_alike = all_alike && uniform_[other] == uniform_[at] &&
                        (other == last || adjacent_to_next[other]);
        }
        if (uniform_[at] && all_alike) continue;
        planned_.push_back({at, near_sampled, uniform_[at].value_or(CellStatus::not_seen),
                            static_cast<bool>(adjacent_to_next[at])});
    }
}

}  // namespace stormcellar::grid
