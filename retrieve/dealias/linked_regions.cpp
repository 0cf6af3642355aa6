#include "retrieve/dealias/linked_regions.h"

#include <algorithm>
#include <cmath>

#include "retrieve/dealias/unfolded_sheet.h"

namespace stormcellar::retrieve {
namespace {

// Smaller regions cannot have many gates of two fold numbers.
constexpr std::int32_t least_gates = 512;

// Returns a number of jumps that noise at the border of a region hardly reaches. The border grows
// as the square root of the number of gates.
float least_jumps_of(std::int32_t gates) {
    return std::max(20.0F, 0.2F * std::sqrt(static_cast<float>(gates)));
}

// Returns the region of a gate with a value.
std::size_t region_at(const SheetRegions& regions, int radial, int gate) {
    const auto r = static_cast<std::size_t>(radial);
    const auto begin = regions.runs.begin();
    const auto run =
        std::upper_bound(begin + static_cast<std::ptrdiff_t>(regions.first_run[r]),
                         begin + static_cast<std::ptrdiff_t>(regions.first_run[r + 1]), gate,
                         [](int number, const Run& of) { return number < of.end; });
    return static_cast<std::size_t>(run->region);
}

}  // namespace

std::vector<std::uint8_t> linked_regions(const VelocitySheet& sheet, const SheetRegions& regions,
                                         const std::vector<std::int8_t>& folds) {
    const UnfoldedSheet unfolded(sheet, folds);
    std::vector<int> jumps(regions.gate_count.size());
    const auto count = [&](int radial, int gate, int other_radial, int other_gate) {
        const float apart = unfolded.row(radial)[gate] - unfolded.row(other_radial)[other_gate];
        if (!(std::abs(apart) > UnfoldedSheet::jump_turns)) return;
        const std::size_t a = region_at(regions, radial, gate);
        const std::size_t b = region_at(regions, other_radial, other_gate);
        if (a == b) return;
        ++jumps[a];
        ++jumps[b];
    };
    for (int radial = 0; radial < sheet.radials; ++radial) {
        for (int run = 0; run < unfolded.runs(); ++run) {
            if (!unfolded.jumps(radial, run)) continue;
            const int first = run * UnfoldedSheet::run_gates;
            for (int gate = first; gate < first + UnfoldedSheet::run_gates; ++gate) {
                count(radial, gate, radial, gate + 1);
                count(radial, gate, unfolded.after(radial), gate);
            }
        }
    }
    std::vector<std::uint8_t> linked;
    linked.reserve(jumps.size());
    for (std::size_t region = 0; region < jumps.size(); ++region) {
        const std::int32_t gates = regions.gate_count[region];
        const bool is_linked =
            gates >= least_gates && static_cast<float>(jumps[region]) >= least_jumps_of(gates);
        linked.push_back(is_linked ? 1 : 0);
    }
    return linked;
}

}  // namespace stormcellar::retrieve
