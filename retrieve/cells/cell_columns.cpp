#include "retrieve/cells/cell_columns.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace stormcellar::retrieve {
namespace {

// The moment AZSH has the unit 0.001/s (stormcellar/level2/moment.h).
constexpr float per_s = 0.001F;

LiquidColumn liquid_column(const CellFields& fields) {
    const std::vector<double>& levels_m = fields.reflectivity.spec->levels_m;
    const std::vector<double> thickness_m = layer_thickness_m(levels_m);
    return {levels_m, levels_m.front() - thickness_m.front() / 2,
            levels_m.back() + thickness_m.back() / 2, fields.radar_m};
}

}  // namespace

std::vector<double> layer_thickness_m(std::span<const double> levels_m) {
    const std::size_t n = levels_m.size();
    std::vector<double> thickness_m(n, 0.0);
    for (std::size_t i = 0; n > 1 && i < n; ++i) {
        const double below_m = i == 0 ? levels_m[1] - levels_m[0] : levels_m[i] - levels_m[i - 1];
        const double above_m =
            i + 1 == n ? levels_m[i] - levels_m[i - 1] : levels_m[i + 1] - levels_m[i];
        thickness_m[i] = (below_m + above_m) / 2;
    }
    return thickness_m;
}

ColumnMeter::ColumnMeter(const CellFields& fields, std::optional<HailLayers> hail, float top_dbz)
    : fields_(fields),
      hail_(std::move(hail)),
      top_dbz_(top_dbz),
      liquid_(liquid_column(fields)),
      dbz_(liquid_.levels_m.size()),
      seen_(dbz_.size()) {}

void ColumnMeter::measure(StormCell& cell) {
    double most_liquid = 0;
    std::vector<float> most_hail_dbz;  // of the column with the largest MESH
    for (const ColumnRun& run : cell.columns) {
        for (int ix = run.first_x; ix < run.end_x; ++ix) {
            read(ix, run.iy);
            measure_top(cell);
            most_liquid = std::max(most_liquid, vertical_liquid_kg_per_m2(liquid_, dbz_, seen_));
            if (hail_) {
                const float mesh_mm = hail_of_column(*hail_, dbz_).mesh_mm;
                if (!cell.mesh_mm || mesh_mm > *cell.mesh_mm) most_hail_dbz = dbz_;
                cell.mesh_mm = std::max(cell.mesh_mm.value_or(0), mesh_mm);
            }
            if (const auto shear = greatest_shear(ix, run.iy)) {
                cell.azimuthal_shear_per_s =
                    std::max(cell.azimuthal_shear_per_s.value_or(*shear), *shear);
            }
        }
    }
    cell.vil_kg_per_m2 = static_cast<float>(most_liquid);
    if (!cell.mesh_mm || !fields_.freezing) return;
    const auto range = mesh_range(fields_.reflectivity.spec->levels_m, most_hail_dbz,
                                  *fields_.freezing, usual_level_error_m);
    if (range) cell.mesh_range = *range;
}

void ColumnMeter::read(int ix, int iy) {
    const grid::BrickView& view = fields_.reflectivity;
    for (std::size_t i = 0; i < dbz_.size(); ++i) {
        const auto iz = static_cast<int>(i);
        seen_[i] = view.status(ix, iy, iz);
        const bool has_value = seen_[i] == grid::CellStatus::value;
        dbz_[i] = has_value ? view.value(ix, iy, iz) : std::numeric_limits<float>::quiet_NaN();
    }
}

// Takes the highest echo of the column. Between two levels with values, reflectivity is linear.
void ColumnMeter::measure_top(StormCell& cell) const {
    const std::vector<double>& levels_m = fields_.reflectivity.spec->levels_m;
    std::size_t i = dbz_.size();
    while (i > 0 && !(dbz_[i - 1] >= top_dbz_))
        --i;
    if (i == 0) return;
    const std::size_t highest = i - 1;
    double top_m = levels_m[highest];
    if (i == dbz_.size() || !is_seen(seen_[i])) {
        cell.top_is_at_least = true;
    } else if (seen_[i] == grid::CellStatus::value) {
        const auto share =
            static_cast<double>((dbz_[highest] - top_dbz_) / (dbz_[highest] - dbz_[i]));
        top_m = std::lerp(levels_m[highest], levels_m[i], share);
    }
    cell.top_m = std::max(cell.top_m, static_cast<float>(top_m));
}

// Returns the largest shear of the column where there is echo, because shear outside echo is noise.
std::optional<float> ColumnMeter::greatest_shear(int ix, int iy) const {
    if (!fields_.azimuthal_shear) return std::nullopt;
    const grid::BrickView& view = *fields_.azimuthal_shear;
    std::optional<float> greatest;
    for (std::size_t i = 0; i < dbz_.size(); ++i) {
        const auto iz = static_cast<int>(i);
        if (!(dbz_[i] >= top_dbz_) || view.status(ix, iy, iz) != grid::CellStatus::value) continue;
        const float shear_per_s = per_s * view.value(ix, iy, iz);
        greatest = std::max(greatest.value_or(shear_per_s), shear_per_s);
    }
    return greatest;
}

}  // namespace stormcellar::retrieve
