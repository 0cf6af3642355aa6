#include "stormcellar/grid/grid_sampler.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stormcellar::grid {
namespace {

// The cells before and after a place along one axis, and the fraction of the way between them.
struct Between {
    int first = 0;
    int second = 0;
    float fraction = 0;
};

std::optional<Between> between(double place, int cells) {
    // This form of the test also refuses NaN.
    if (!std::isgreaterequal(place, 0.0) || !std::islessequal(place, cells - 1.0)) {
        return std::nullopt;
    }
    const int first = std::min(static_cast<int>(place), std::max(cells - 2, 0));
    return Between{first, std::min(first + 1, cells - 1), static_cast<float>(place - first)};
}

}  // namespace

GridSampler::GridSampler(const BrickView& view) : view_(view) {
    const GridSpec& spec = *view.spec;
    for (int ix = 0; ix < spec.nx; ++ix)
        x_.push_back({view.offset_x(ix), view.brick_index(ix / brick_edge, 0, 0)});
    for (int iy = 0; iy < spec.ny; ++iy)
        y_.push_back({view.offset_y(iy), view.brick_index(0, iy / brick_edge, 0)});
    for (int iz = 0; iz < spec.nz(); ++iz)
        z_.push_back({view.offset_z(iz), view.brick_index(0, 0, iz / brick_edge)});
}

double GridSampler::level_at(double height_m) const {
    const std::vector<double>& levels_m = view_.spec->levels_m;
    if (!std::isgreaterequal(height_m, levels_m.front()) ||
        !std::islessequal(height_m, levels_m.back())) {
        return std::numeric_limits<double>::quiet_NaN();
    }
    const auto above = std::lower_bound(levels_m.begin(), levels_m.end(), height_m);
    if (above == levels_m.begin()) return 0;
    const auto below = above - 1;
    return static_cast<double>(below - levels_m.begin()) + (height_m - *below) / (*above - *below);
}

std::size_t GridSampler::brick_of(int ix, int iy, int iz) const {
    return x_[static_cast<std::size_t>(ix)].brick + y_[static_cast<std::size_t>(iy)].brick +
           z_[static_cast<std::size_t>(iz)].brick;
}

void GridSampler::read(Cell cell, Corner& corner) const {
    const Step& x = x_[static_cast<std::size_t>(cell.ix)];
    const Step& y = y_[static_cast<std::size_t>(cell.iy)];
    const Step& z = z_[static_cast<std::size_t>(cell.iz)];
    const BrickEntry& brick = view_.bricks[x.brick + y.brick + z.brick];
    if (brick.kind == BrickKind::uniform) {
        corner.status = brick.uniform_status;
        return;
    }
    if (brick.kind == BrickKind::status_only) {
        corner.status = view_.status(cell.ix, cell.iy, cell.iz);
        return;
    }
    const std::uint16_t code = view_.code_at(x.offset + y.offset + z.offset);
    corner.status = view_.quantization.status_of(code);
    if (corner.status == CellStatus::value) corner.value = view_.quantization.value_of(code);
}

bool GridSampler::find(ColumnPoint column, double level, Corners& corners) const {
    const auto x = between(column.x, view_.spec->nx);
    const auto y = between(column.y, view_.spec->ny);
    const auto z = between(level, view_.spec->nz());
    if (!x || !y || !z) return false;
    // Most places are within one brick that has a single state. Then no cell need be read.
    const std::size_t brick = brick_of(x->first, y->first, z->first);
    if (view_.bricks[brick].kind == BrickKind::uniform &&
        brick == brick_of(x->second, y->second, z->second)) {
        corners = {};
        corners[0] = {view_.bricks[brick].uniform_status, 0, 1};
        for (Corner& corner : corners)
            corner.status = corners[0].status;
        return true;
    }
    for (unsigned i = 0; i < corners.size(); ++i) {
        const bool next_x = (i & 1U) != 0;
        const bool next_y = (i & 2U) != 0;
        const bool next_z = (i & 4U) != 0;
        corners[i].weight = (next_x ? x->fraction : 1 - x->fraction) *
                            (next_y ? y->fraction : 1 - y->fraction) *
                            (next_z ? z->fraction : 1 - z->fraction);
        read({next_x ? x->second : x->first, next_y ? y->second : y->first,
              next_z ? z->second : z->first},
             corners[i]);
    }
    return true;
}

std::optional<float> GridSampler::value(ColumnPoint column, double level) const {
    Corners corners;
    if (!find(column, level, corners)) return std::nullopt;
    float sum = 0;
    for (const Corner& corner : corners) {
        if (corner.weight <= 0) continue;
        if (corner.status != CellStatus::value) return std::nullopt;
        sum += corner.weight * corner.value;
    }
    return sum;
}

}  // namespace stormcellar::grid
