#include "level2/decode/late_radials.h"

#include <algorithm>
#include <chrono>
#include <tuple>

#include "level2/decode/fragment_builder.h"

namespace stormcellar::level2 {
namespace {

// The slowest pattern takes ten minutes for a volume, and little more than one minute for a turn of
// the antenna.
constexpr std::chrono::minutes longest_volume{15};
constexpr std::chrono::minutes longest_turn{2};

bool is_same(const Radial& a, const Radial& b) {
    return a.time == b.time && a.azimuth_number == b.azimuth_number &&
           a.azimuth_deg == b.azimuth_deg;
}

bool follow(const Radial& first, const Radial& second) {
    return first.azimuth_number < second.azimuth_number && first.time <= second.time &&
           second.time - first.time <= longest_turn && !ends_sweep(first) && !begins_sweep(second);
}

}  // namespace

bool goes_back(const Radial& radial, UtcTime newer) {
    return radial.time < newer && newer - radial.time <= longest_volume;
}

LateFit fit_at(const Sweep& sweep, std::size_t at, const Radial* before, const Radial& radial) {
    const Radial* const next = at < sweep.radials.size() ? &sweep.radials[at] : nullptr;
    if (next != nullptr && is_same(radial, *next)) return LateFit::repeats;
    if (before == nullptr && next == nullptr) return LateFit::none;
    const bool fits = (before == nullptr || follow(*before, radial)) &&
                      (next == nullptr || follow(radial, *next));
    return fits ? LateFit::fills_gap : LateFit::none;
}

std::optional<std::size_t> place_of_late(const Sweep& sweep, const Radial& radial) {
    const auto& radials = sweep.radials;
    // A TDWR counts whole seconds, so many radials share a time.
    const auto order = [](const Radial& r) { return std::tuple(r.time, r.azimuth_number); };
    const auto not_older = std::find_if(radials.begin(), radials.end(), [&](const Radial& other) {
        return order(other) >= order(radial);
    });
    const auto at = static_cast<std::size_t>(not_older - radials.begin());
    const Radial* const before = at == 0 ? nullptr : &radials[at - 1];
    if (fit_at(sweep, at, before, radial) == LateFit::none) return std::nullopt;
    return at;
}

}  // namespace stormcellar::level2
