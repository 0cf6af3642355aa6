#include "grid/cells/level_range.h"

#include <cmath>

#include "base/number_list.h"
#include "stormcellar/grid/grid_spec.h"

namespace stormcellar::grid {

double metres_of_km(double km) {
    return std::round(km * 1e6) / 1e3;
}

std::optional<std::vector<double>> parse_level_range(std::string_view text) {
    const auto range_km = parse_numbers(text, ':');
    if (!range_km || range_km->size() != 3) return std::nullopt;
    const double bottom = range_km->front();
    const double top = (*range_km)[1];
    const double step = range_km->back();
    if (!(step > 0) || !(top >= bottom)) return std::nullopt;
    const double steps = std::floor((top - bottom) / step + 1e-6);
    if (!(steps < GridSpec::greatest_level_count)) return std::nullopt;
    std::vector<double> levels_m;
    for (int i = 0; i <= static_cast<int>(steps); ++i)
        levels_m.push_back(metres_of_km(bottom + i * step));
    return levels_m;
}

}  // namespace stormcellar::grid
