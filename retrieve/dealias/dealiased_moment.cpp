// Makes the moment VELD, tests whether a volume needs dealiasing, and names the rungs (the ways to
// dealias).
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "base/printable.h"
#include "retrieve/dealias/fine_velocity.h"
#include "retrieve/dealias/velocity_sheet.h"
#include "stormcellar/retrieve/dealias.h"

namespace stormcellar::retrieve {
namespace {

using level2::Moment;
using level2::SweepMoment;

constexpr std::array<std::pair<Dealiasing, std::string_view>, 5> rung_names = {
    {{Dealiasing::off, "off"},
     {Dealiasing::profile, "profile"},
     {Dealiasing::region, "region"},
     {Dealiasing::anchored, "anchored"},
     {Dealiasing::automatic, "auto"}}};

constexpr float greatest_mps = 320;
constexpr std::uint16_t ambiguous_code = 2;

std::uint16_t dealiased_code(const SweepMoment& raw, std::uint16_t code, float nyquist_mps,
                             int fold, bool is_ambiguous) {
    if (code < level2::facts_of(raw.moment).first_valid_code) return code;
    const float turned = fold == 0 ? 0 : 2 * static_cast<float>(fold) * nyquist_mps;
    const float velocity = raw.value_of(code) + turned;
    const bool has_value = !is_ambiguous && std::abs(velocity) <= greatest_mps;
    if (!has_value) return ambiguous_code;
    return fine_velocity_code(velocity);
}

SweepMoment dealiased_moment(const level2::Sweep& sweep, const SweepFolds& folds) {
    const SweepMoment& raw = sweep.moments[folds.moment];
    SweepMoment made = with_fine_codes(raw, folds.folds.size());
    made.moment = Moment::veld;
    for (std::size_t radial = 0; radial < sweep.radials.size(); ++radial) {
        const float nyquist_mps = sweep.radials[radial].nyquist_mps;
        const std::size_t row = radial * static_cast<std::size_t>(raw.gate_stride);
        for (std::int32_t gate = 0; gate < raw.gate_counts[radial]; ++gate) {
            const std::size_t at = row + static_cast<std::size_t>(gate);
            made.codes16[at] = dealiased_code(raw, raw.code(radial, gate), nyquist_mps,
                                              folds.folds[at], folds.ambiguous[at] != 0);
        }
    }
    return made;
}

}  // namespace

std::string_view dealiasing_name(Dealiasing rung) {
    return rung_names[static_cast<std::size_t>(rung)].second;
}

Result<Dealiasing> dealiasing_from_name(std::string_view name) {
    for (const auto& [rung, word] : rung_names)
        if (word == name) return rung;
    return fail(ErrorCode::bad_argument, "'{}' is no way to dealias; it must be {}",
                printable(name), dealiasing_names());
}

std::string dealiasing_names() {
    return "off, auto, profile, region or anchored";
}

bool needs_dealiasing(const level2::Volume& volume) {
    constexpr std::int64_t pairs_per_jump = 10'000;
    std::int64_t pairs = 0, jumps = 0;
    const auto meet = [&](float a, float b) {
        pairs += std::isnan(a - b) ? 0 : 1;
        jumps += turns_apart(a, b) > 0.5F ? 1 : 0;
    };
    for (const VelocitySheet& sheet : velocity_sheets(volume)) {
        for (int radial = 0; radial < sheet.radials; ++radial) {
            const float* row = sheet.row(radial);
            const float* next = radial + 1 < sheet.radials ? sheet.row(radial + 1)
                                : sheet.is_circle          ? sheet.row(0)
                                                           : row;
            for (int gate = 0; gate < sheet.gates; ++gate) {
                if (std::isnan(row[gate])) continue;
                if (gate + 1 < sheet.gates) meet(row[gate], row[gate + 1]);
                if (next != row) meet(row[gate], next[gate]);
            }
        }
    }
    return jumps * pairs_per_jump > pairs;
}

Result<Dealiased> add_dealiased_velocity(level2::Volume& volume, Dealiasing rung,
                                         std::span<const level2::Sweep> known) {
    for (level2::Sweep& sweep : volume.sweeps)
        std::erase_if(sweep.moments,
                      [](const SweepMoment& kind) { return kind.moment == Moment::veld; });
    Dealiased dealiased = dealias(volume, rung, known);
    if (dealiased.sweeps.empty()) return fail(ErrorCode::not_found, "the volume has no velocities");
    for (const SweepFolds& folds : dealiased.sweeps) {
        level2::Sweep& sweep = volume.sweeps[folds.sweep];
        sweep.moments.push_back(dealiased_moment(sweep, folds));
    }
    return dealiased;
}

}  // namespace stormcellar::retrieve
