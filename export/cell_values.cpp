#include "export/cell_values.h"

#include <array>
#include <cmath>

namespace stormcellar::cell_export {
namespace {

using retrieve::TrackedCell;
using Number = std::optional<double>;

constexpr auto table = std::to_array<CellValue>({
    {"latitude_deg", position_decimals,
     [](const TrackedCell& c) { return Number(c.cell.position.latitude_deg); }},
    {"longitude_deg", position_decimals,
     [](const TrackedCell& c) { return Number(c.cell.position.longitude_deg); }},
    {"area_km2", 1, [](const TrackedCell& c) { return Number(c.cell.area_km2); }},
    {"max_dbz", 1, [](const TrackedCell& c) { return Number(c.cell.max_dbz); }},
    {"max_dbz_height_m", 0, [](const TrackedCell& c) { return Number(c.cell.max_dbz_height_m); }},
    {"top_m", 0, [](const TrackedCell& c) { return Number(c.cell.top_m); }},
    {"vil_kg_per_m2", 1, [](const TrackedCell& c) { return Number(c.cell.vil_kg_per_m2); }},
    {"mesh_mm", 1, [](const TrackedCell& c) { return Number(c.cell.mesh_mm); }},
    {"mesh_least_mm", 1,
     [](const TrackedCell& c) {
         return c.cell.mesh_range ? Number(c.cell.mesh_range->least_mm) : std::nullopt;
     }},
    {"mesh_most_mm", 1,
     [](const TrackedCell& c) {
         return c.cell.mesh_range ? Number(c.cell.mesh_range->most_mm) : std::nullopt;
     }},
    {"azimuthal_shear_per_s", 4,
     [](const TrackedCell& c) { return Number(c.cell.azimuthal_shear_per_s); }},
    {"motion_east_mps", 1,
     [](const TrackedCell& c) {
         return c.motion ? Number(c.motion->velocity.u_mps) : std::nullopt;
     }},
    {"motion_north_mps", 1,
     [](const TrackedCell& c) {
         return c.motion ? Number(c.motion->velocity.v_mps) : std::nullopt;
     }},
    {"motion_error_mps", 1,
     [](const TrackedCell& c) { return c.motion ? Number(c.motion->error_mps) : std::nullopt; }},
});

}  // namespace

std::span<const CellValue> cell_values() {
    return table;
}

double rounded(double value, int decimals) {
    const double scale = std::pow(10.0, decimals);
    return std::round(value * scale) / scale + 0.0;  // no -0
}

}  // namespace stormcellar::cell_export
