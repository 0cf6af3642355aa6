#include "stormcellar/retrieve/vertical_liquid.h"

#include <algorithm>
#include <cmath>

namespace stormcellar::retrieve {
namespace {

using grid::CellStatus;

constexpr double most_liquid_dbz = 56;

bool was_seen(CellStatus status) {
    return status == CellStatus::value || status == CellStatus::no_echo;
}

// Returns Z in mm6/m3; 0 without a value.
double liquid_z(CellStatus status, float dbz) {
    if (status != CellStatus::value) return 0;
    return std::pow(10.0, std::min(static_cast<double>(dbz), most_liquid_dbz) / 10);
}

double liquid_of_layer(double z, double thickness_m) {
    return z > 0 ? 3.44e-6 * std::pow(z, 4.0 / 7) * thickness_m : 0;
}

// Returns the height at which the sum of liquid begins. From there to the lowest cell that was
// seen, the value of this cell counts.
double start_of_liquid_m(const LiquidColumn& column, std::size_t lowest) {
    const std::span<const double> levels_m = column.levels_m;
    if (column.radar_m)
        return std::min(levels_m[lowest], std::max(column.bottom_m, *column.radar_m));
    return lowest == 0 ? column.bottom_m : (levels_m[lowest - 1] + levels_m[lowest]) / 2;
}

}  // namespace

double vertical_liquid_kg_per_m2(const LiquidColumn& column, std::span<const float> dbz,
                                 std::span<const CellStatus> status) {
    const std::span<const double> levels_m = column.levels_m;
    const auto first = std::ranges::find_if(status, was_seen);
    if (first == status.end()) return 0;
    const auto lowest = static_cast<std::size_t>(first - status.begin());
    const std::size_t last = levels_m.size() - 1;
    double below_z = liquid_z(status[lowest], dbz[lowest]);
    double sum = liquid_of_layer(below_z, levels_m[lowest] - start_of_liquid_m(column, lowest));
    for (std::size_t i = lowest; i < last; ++i) {
        const double thickness_m = levels_m[i + 1] - levels_m[i];
        const double above_z = liquid_z(status[i + 1], dbz[i + 1]);
        if (was_seen(status[i]) && was_seen(status[i + 1])) {
            sum += liquid_of_layer((below_z + above_z) / 2, thickness_m);
        } else {
            // A cell that was not seen has Z = 0.
            sum += liquid_of_layer(below_z + above_z, thickness_m / 2);
        }
        below_z = above_z;
    }
    return sum + liquid_of_layer(below_z, column.top_m - levels_m[last]);
}

std::optional<double> mean_radar_height_m(std::span<const grid::SitePosition> sites) {
    if (sites.empty()) return std::nullopt;
    double sum_m = 0;
    for (const grid::SitePosition& site : sites)
        sum_m += site.altitude_m;
    return sum_m / static_cast<double>(sites.size());
}

}  // namespace stormcellar::retrieve
