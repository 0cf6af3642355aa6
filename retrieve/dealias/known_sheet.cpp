#include "retrieve/dealias/known_sheet.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/degree.h"

namespace stormcellar::retrieve {
namespace {

// A vote loses a factor of e in the first time, and does not count after the second.
constexpr double time_of_decay_s = 300, most_age_s = 900;
// Sheets are compared by their distance from each other at this range.
constexpr double typical_range_m = 60'000;
constexpr std::size_t most_voters = 2;

double weight_by_age(const VelocitySheet& known, const VelocitySheet& sheet) {
    const double age_s = std::abs(seconds_between(known.time, sheet.time));
    return age_s > most_age_s ? 0 : std::exp(-age_s / time_of_decay_s);
}

double weight_by_elevation(const VelocitySheet& known, const VelocitySheet& sheet) {
    const double apart_deg = std::abs(known.elevation_deg - sheet.elevation_deg);
    return std::exp(-apart_deg * degree * typical_range_m / height_of_decay_m);
}

}  // namespace

std::vector<SheetState> known_sheets(std::span<const level2::Sweep> dealiased) {
    std::vector<SheetState> known;
    for (const level2::Sweep& sweep : dealiased) {
        for (std::size_t m = 0; m < sweep.moments.size(); ++m) {
            if (sweep.moments[m].moment != level2::Moment::veld) continue;
            for (VelocitySheet& sheet : velocity_sheets(sweep, m)) {
                SheetState& state = known.emplace_back();
                state.heights_m = gate_heights_m(sheet);
                state.gate_folds.assign(sheet.turns.size(), 0);
                state.sheet = std::move(sheet);
            }
        }
    }
    return known;
}

void anchor_to_known(std::span<const SheetState> known, const SheetState& state,
                     std::vector<Votes>& anchors) {
    struct Voter {
        const SheetState* of = nullptr;
        double weight = 0;
    };
    std::vector<Voter> voters;
    for (const SheetState& of : known) {
        const double by_age = weight_by_age(of.sheet, state.sheet);
        if (by_age > 0)
            voters.push_back({&of, by_age * weight_by_elevation(of.sheet, state.sheet)});
    }
    std::ranges::stable_sort(voters, std::ranges::greater{}, &Voter::weight);
    voters.resize(std::min(voters.size(), most_voters));
    for (const Voter& voter : voters) {
        const auto by_age = static_cast<float>(weight_by_age(voter.of->sheet, state.sheet));
        anchor_to_sheet(*voter.of, state, anchors, neighbor_weight * by_age);
    }
}

}  // namespace stormcellar::retrieve
