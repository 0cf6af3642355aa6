#include "retrieve/shear/velocity_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "retrieve/dealias/velocity_sheet.h"
#include "stormcellar/grid/sweep_choice.h"

namespace stormcellar::retrieve {
namespace {

constexpr double nearest_m = 1000;
constexpr float none = std::numeric_limits<float>::quiet_NaN();

struct SheetRow {
    const VelocitySheet* sheet;
    int row;
    [[nodiscard]] float azimuth_deg() const {
        return sheet->azimuths_deg[static_cast<std::size_t>(row)];
    }
    [[nodiscard]] std::size_t radial() const {
        return sheet->first_radial + static_cast<std::size_t>(row);
    }
};

std::vector<SheetRow> rows_by_azimuth(const std::vector<VelocitySheet>& sheets) {
    std::vector<SheetRow> rows;
    for (const VelocitySheet& sheet : sheets)
        for (int row = 0; row < sheet.radials; ++row)
            rows.push_back({&sheet, row});
    std::ranges::stable_sort(rows, {}, &SheetRow::azimuth_deg);
    return rows;
}

// Returns the number of gates up to a range.
std::size_t gates_within(const level2::SweepMoment& moment, double farthest_m) {
    const double last = (farthest_m - moment.first_gate_m) / moment.gate_spacing_m;
    return static_cast<std::size_t>(
        std::clamp(std::floor(last) + 1, 0.0, static_cast<double>(moment.gate_stride)));
}

}  // namespace

VelocityRows velocity_rows(const level2::Sweep& sweep, const SweepFolds& folds, double farthest_m) {
    VelocityRows rows;
    const level2::SweepMoment& moment = sweep.moments[folds.moment];
    if (moment.gate_spacing_m <= 0) return rows;
    const std::vector<VelocitySheet> sheets = velocity_sheets(sweep, folds.moment);
    rows.gates = gates_within(moment, farthest_m);
    rows.first_gate_m = moment.first_gate_m;
    rows.gate_spacing_m = moment.gate_spacing_m;
    rows.step_mps = moment.scale > 0 ? 1 / static_cast<double>(moment.scale) : 1;
    const std::size_t first_gate =
        gates_within(moment, std::nextafter(nearest_m, 0));  // the first at 1 km or beyond
    for (const SheetRow& from : rows_by_azimuth(sheets)) {
        const auto turn_mps = static_cast<float>(from.sheet->turn_mps);
        const float* turns = from.sheet->row(from.row);
        const std::size_t row = from.radial() * static_cast<std::size_t>(moment.gate_stride);
        rows.radials.push_back(from.radial());
        rows.azimuths_deg.push_back(from.azimuth_deg());
        rows.elevation_deg += static_cast<double>(sweep.radials[from.radial()].elevation_deg);
        for (std::size_t gate = 0; gate < rows.gates; ++gate) {
            const bool is_left_out = gate < first_gate || folds.ambiguous[row + gate] != 0;
            const float all_turns = turns[gate] + static_cast<float>(folds.folds[row + gate]);
            rows.velocities_mps.push_back(is_left_out ? none : all_turns * turn_mps);
        }
    }
    if (rows.radials.empty()) return rows;
    rows.elevation_deg /= static_cast<double>(rows.row_count());
    rows.azimuth_spacing_deg =
        grid::azimuth_spacing_deg(rows.azimuths_deg, sweep.azimuth_spacing_deg);
    return rows;
}

}  // namespace stormcellar::retrieve
