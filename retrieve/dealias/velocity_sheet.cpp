#include "retrieve/dealias/velocity_sheet.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/floating_point.h"

namespace stormcellar::retrieve {
namespace {

constexpr double most_turns = 100;
constexpr float no_value = std::numeric_limits<float>::quiet_NaN();

// Converts codes to turns.
class TurnsOfCodes {
  public:
    TurnsOfCodes(const level2::SweepMoment& moment, double turn_mps)
        : moment_(moment), per_turn_(1 / turn_mps) {
        if (moment.word_size_bits != 8) return;
        table_.resize(256);
        for (std::uint16_t code = 0; code < 256; ++code)
            table_[code] = compute(code);
    }
    void fill(std::size_t radial, float* row) const {
        const auto count = static_cast<std::int32_t>(moment_.gate_counts[radial]);
        for (std::int32_t gate = 0; gate < count; ++gate) {
            const std::uint16_t code = moment_.code(radial, gate);
            row[gate] = table_.empty() ? compute(code) : table_[code];
        }
    }

  private:
    [[nodiscard]] float compute(std::uint16_t code) const {
        if (level2::status_of_code(moment_.moment, code) != level2::GateStatus::valid)
            return no_value;
        const double turns = static_cast<double>(moment_.value_of(code)) * per_turn_;
        return std::abs(turns) < most_turns ? static_cast<float>(turns) : no_value;
    }

    const level2::SweepMoment& moment_;
    double per_turn_;
    std::vector<float> table_;
};

// Returns true if there are at least 90 radials, and the step from the last to the first radial is
// at most three usual steps.
bool closes(const std::vector<float>& azimuths_deg) {
    if (azimuths_deg.size() < 90) return false;
    const double step = std::remainder(azimuths_deg.front() - azimuths_deg.back(), 360.0);
    return std::abs(step) <= 3 * 360.0 / static_cast<double>(azimuths_deg.size());
}

VelocitySheet sheet_of(const level2::Sweep& sweep, const level2::SweepMoment& moment,
                       std::size_t first, std::size_t end) {
    VelocitySheet sheet;
    sheet.first_radial = first;
    sheet.radials = static_cast<int>(end - first);
    sheet.gates = moment.gate_stride;
    sheet.first_gate_m = moment.first_gate_m;
    sheet.gate_spacing_m = moment.gate_spacing_m;
    sheet.turn_mps = 2 * static_cast<double>(sweep.radials[first].nyquist_mps);
    sheet.turns.assign((end - first) * static_cast<std::size_t>(sheet.gates), no_value);
    const TurnsOfCodes turns(moment, sheet.turn_mps);
    sheet.time = sweep.radials[(first + end) / 2].time;
    double elevations = 0;
    for (std::size_t radial = first; radial < end; ++radial) {
        turns.fill(radial, sheet.turns.data() + sheet.at(static_cast<int>(radial - first), 0));
        const float azimuth = std::fmod(sweep.radials[radial].azimuth_deg, 360.0F);
        sheet.azimuths_deg.push_back(azimuth < 0 ? azimuth + 360 : azimuth);
        elevations += static_cast<double>(sweep.radials[radial].elevation_deg);
    }
    sheet.elevation_deg = elevations / sheet.radials;
    sheet.is_circle = closes(sheet.azimuths_deg);
    return sheet;
}

}  // namespace

bool can_be_unfolded(const level2::Radial& radial) {
    return is_within(radial.nyquist_mps, least_nyquist_mps, most_nyquist_mps) &&
           std::isfinite(radial.azimuth_deg) && std::isfinite(radial.elevation_deg);
}

std::vector<VelocitySheet> velocity_sheets(const level2::Sweep& sweep, std::size_t moment_index) {
    std::vector<VelocitySheet> sheets;
    const level2::SweepMoment& moment = sweep.moments[moment_index];
    const bool is_velocity =
        moment.moment == level2::Moment::vel || moment.moment == level2::Moment::veld;
    if (!is_velocity || moment.gate_stride <= 0 || moment.gate_spacing_m <= 0) return sheets;
    const auto counts = [&](std::size_t radial) {
        return moment.gate_counts[radial] > 0 && can_be_unfolded(sweep.radials[radial]);
    };
    for (std::size_t first = 0; first < sweep.radials.size();) {
        std::size_t end = first + 1;
        while (end < sweep.radials.size() && counts(end) == counts(first) &&
               sweep.radials[end].nyquist_mps == sweep.radials[first].nyquist_mps)
            ++end;
        if (counts(first)) {
            VelocitySheet sheet = sheet_of(sweep, moment, first, end);
            sheet.moment = moment_index;
            const bool has_values =
                std::ranges::any_of(sheet.turns, [](float turns) { return !std::isnan(turns); });
            if (has_values) sheets.push_back(std::move(sheet));
        }
        first = end;
    }
    return sheets;
}

std::vector<VelocitySheet> velocity_sheets(const level2::Volume& volume) {
    std::vector<VelocitySheet> sheets;
    for (std::size_t s = 0; s < volume.sweeps.size(); ++s) {
        for (std::size_t m = 0; m < volume.sweeps[s].moments.size(); ++m) {
            if (volume.sweeps[s].moments[m].moment != level2::Moment::vel) continue;
            for (VelocitySheet& sheet : velocity_sheets(volume.sweeps[s], m)) {
                sheet.sweep = s;
                sheets.push_back(std::move(sheet));
            }
        }
    }
    return sheets;
}

void drop_empty_gates(VelocitySheet& sheet) {
    int kept = 0;
    for (int radial = 0; radial < sheet.radials; ++radial) {
        const float* row = sheet.row(radial);
        int gate = sheet.gates;
        while (gate > kept && std::isnan(row[gate - 1]))
            --gate;
        kept = gate;
    }
    auto to = sheet.turns.begin();
    for (int radial = 0; radial < sheet.radials; ++radial) {
        const auto from = sheet.turns.begin() + static_cast<std::ptrdiff_t>(sheet.at(radial, 0));
        to = std::copy(from, from + kept, to);
    }
    sheet.turns.resize(static_cast<std::size_t>(sheet.radials) * static_cast<std::size_t>(kept));
    sheet.gates = kept;
}

}  // namespace stormcellar::retrieve
