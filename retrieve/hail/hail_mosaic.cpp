#include "retrieve/hail/hail_mosaic.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

#include "stormcellar/grid/grid_window.h"

namespace stormcellar::retrieve {

HailMosaic::HailMosaic(grid::GridSpec spec, HailLayers layers)
    : spec_(std::move(spec)), layers_(std::move(layers)), largest_shi_(spec_.column_count(), 0) {}

Result<HailMosaic> HailMosaic::make(const grid::GridSpec& spec, const FreezingLevels& levels) {
    auto layers = hail_layers(spec.levels_m, levels, 0);  // SHI does not depend on the radar
    if (!layers) return pass_on(layers);
    return HailMosaic(spec, std::move(*layers));
}

Status HailMosaic::add(const grid::Grid& radar, grid::Grid& mosaic) {
    const auto window = grid::window_of(spec_, radar.spec);
    if (!window || !(mosaic.spec == spec_))
        return fail(ErrorCode::bad_argument, "the hail of radars on different grids cannot merge");
    for (int iy = 0; iy < window->ny; ++iy)
        for (int ix = 0; ix < window->nx; ++ix)
            add_column(radar, radar.spec.index(ix, iy, 0), mosaic,
                       spec_.index(window->first_x + ix, window->first_y + iy, 0));
    return {};
}

void HailMosaic::add_column(const grid::Grid& radar, std::size_t from, grid::Grid& mosaic,
                            std::size_t to) {
    const std::size_t levels = spec_.levels_m.size();
    dbz_.resize(levels);
    for (std::size_t i = 0; i < levels; ++i) {
        dbz_[i] = radar.status[from + i] == grid::CellStatus::value
                      ? radar.values[from + i]
                      : std::numeric_limits<float>::quiet_NaN();
    }
    float& largest = largest_shi_[to / levels];
    const float shi = hail_of_column(layers_, dbz_).shi_j_per_m_s;
    if (!(shi > largest)) return;
    largest = shi;
    const auto source = static_cast<std::ptrdiff_t>(from), place = static_cast<std::ptrdiff_t>(to);
    std::copy_n(radar.values.begin() + source, levels, mosaic.values.begin() + place);
    std::copy_n(radar.status.begin() + source, levels, mosaic.status.begin() + place);
}

}  // namespace stormcellar::retrieve
