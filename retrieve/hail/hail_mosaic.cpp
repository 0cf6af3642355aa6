#include "retrieve/hail/hail_mosaic.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

namespace stormcellar::retrieve {

HailMosaic::HailMosaic(grid::GridSpec spec, HailLayers layers)
    : spec_(std::move(spec)), layers_(std::move(layers)), largest_shi_(spec_.column_count(), 0) {}

Result<HailMosaic> HailMosaic::make(const grid::GridSpec& spec, const FreezingLevels& levels) {
    auto layers = hail_layers(spec.levels_m, levels, 0);  // SHI does not depend on the radar
    if (!layers) return pass_on(layers);
    return HailMosaic(spec, std::move(*layers));
}

Status HailMosaic::add(const grid::Grid& radar, grid::Grid& mosaic) {
    if (!(radar.spec == spec_) || !(mosaic.spec == spec_))
        return fail(ErrorCode::bad_argument, "the hail of radars on different grids cannot merge");
    const std::size_t levels = spec_.levels_m.size();
    std::vector<float> dbz(levels);
    for (std::size_t column = 0; column < largest_shi_.size(); ++column) {
        const std::size_t first = column * levels;
        for (std::size_t i = 0; i < levels; ++i) {
            dbz[i] = radar.status[first + i] == grid::CellStatus::value
                         ? radar.values[first + i]
                         : std::numeric_limits<float>::quiet_NaN();
        }
        const float shi = hail_of_column(layers_, dbz).shi_j_per_m_s;
        if (!(shi > largest_shi_[column])) continue;
        largest_shi_[column] = shi;
        const auto from = static_cast<std::ptrdiff_t>(first);
        std::copy_n(radar.values.begin() + from, levels, mosaic.values.begin() + from);
        std::copy_n(radar.status.begin() + from, levels, mosaic.status.begin() + from);
    }
    return {};
}

}  // namespace stormcellar::retrieve
