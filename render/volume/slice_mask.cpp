#include "render/volume/slice_mask.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stormcellar::render {
namespace {

using grid::brick_edge;

// Steps by which a bit may be set too early or too late: covers the rounding of both sides.
constexpr double slack = 0.01;

// The stretch along one axis that brick number b colours: up to the centres of the neighbours'
// nearest cells, or to the box's edge where there are none.
template <class Centre>
void reach(int b, int cells, double edge_low, double edge_high, Centre centre, double& low,
           double& high) {
    const int first = b * brick_edge;
    const int past = first + brick_edge;
    low = first == 0 ? edge_low : centre(first - 1);
    high = past >= cells ? edge_high : centre(past);
}

}  // namespace

SliceMask::SliceMask(const grid::BrickView& view, const ViewGeometry& geometry, int slices,
                     const TransferFunction& transfer)
    : geometry_(geometry),
      slices_(slices),
      step_m_((geometry.far_m() - geometry.near_m()) / slices),
      tiles_across_((geometry.width() + tile_edge - 1) / tile_edge),
      tiles_down_((geometry.height() + tile_edge - 1) / tile_edge),
      words_per_tile_(static_cast<std::size_t>(slices + 63) / 64) {
    for (int bx = 0; bx < view.bricks_x; ++bx) {
        for (int by = 0; by < view.bricks_y; ++by) {
            for (int bz = 0; bz < view.bricks_z; ++bz) {
                const grid::BrickEntry& entry = view.bricks[view.brick_index(bx, by, bz)];
                if (entry.kind != grid::BrickKind::stored || entry.value_count == 0) continue;
                if (transfer.shows(entry.min_code, entry.max_code)) {
                    add_brick(*view.spec, bx, by, bz);
                }
            }
        }
    }
}

void SliceMask::add_brick(const grid::GridSpec& spec, int bx, int by, int bz) {
    Box box{};
    reach(
        bx, spec.nx, -geometry_.half_x_m(), geometry_.half_x_m(),
        [&](int i) { return spec.x_from_middle_m(i); }, box.low[0], box.high[0]);
    reach(
        by, spec.ny, -geometry_.half_y_m(), geometry_.half_y_m(),
        [&](int i) { return spec.y_from_middle_m(i); }, box.low[1], box.high[1]);
    reach(
        bz, spec.nz(), geometry_.bottom_m(), geometry_.top_m(),
        [&](int i) { return spec.levels_m[static_cast<std::size_t>(i)]; }, box.low[2], box.high[2]);
    // The drawn earth's curve takes least off where the box is nearest to the middle.
    const auto nearest = [&](std::size_t axis) {
        return std::clamp(0.0, box.low[axis], box.high[axis]);
    };
    const auto farthest = [&](std::size_t axis) {
        return std::max(std::abs(box.low[axis]), std::abs(box.high[axis]));
    };
    box.low[2] -= geometry_.drop_m(farthest(0), farthest(1));
    box.high[2] -= geometry_.drop_m(nearest(0), nearest(1));
    box.low[2] *= geometry_.exaggeration();
    box.high[2] *= geometry_.exaggeration();
    place_in_picture(box);
    if (box.right >= 0 && box.bottom >= 0 && box.left <= geometry_.width() &&
        box.top <= geometry_.height()) {
        boxes_.push_back(box);
    }
}

void SliceMask::place_in_picture(Box& box) const {
    box.left = box.top = std::numeric_limits<double>::infinity();
    box.right = box.bottom = -box.left;
    double farthest = geometry_.near_m();
    bool behind = false;
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3 point = {(corner & 1) != 0 ? box.high[0] : box.low[0],
                            (corner & 2) != 0 ? box.high[1] : box.low[1],
                            (corner & 4) != 0 ? box.high[2] : box.low[2]};
        const double depth = geometry_.depth_of(point);
        farthest = std::max(farthest, depth);
        if (geometry_.is_perspective() && depth < geometry_.near_m()) {
            behind = true;
            continue;
        }
        const Pixel p = geometry_.project(point);
        box.left = std::min(box.left, p.x);
        box.right = std::max(box.right, p.x);
        box.top = std::min(box.top, p.y);
        box.bottom = std::max(box.bottom, p.y);
    }
    box.tile_half_m = 0.5 * tile_edge * geometry_.metres_per_pixel(farthest);
    if (behind) {  // the camera is in the box or beside it: it may be anywhere in the picture
        box.left = box.top = 0;
        box.right = geometry_.width();
        box.bottom = geometry_.height();
    }
}

// Cuts the ray through the tile's middle with the box, widened by what the tile spans.
void SliceMask::mark(const Box& box, int tile_row, int tile, std::uint64_t* words) const {
    const Pixel middle = {(tile + 0.5) * tile_edge, (tile_row + 0.5) * tile_edge};
    const Vec3 start = geometry_.point(middle, geometry_.near_m());
    const Vec3 direction = geometry_.along(middle);
    double first = 0;
    double last = slices_;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double widen =
            box.tile_half_m * (std::abs(geometry_.right()[axis]) + std::abs(geometry_.up()[axis])) +
            slack * step_m_;
        const double low = box.low[axis] - widen - start[axis];
        const double high = box.high[axis] + widen - start[axis];
        const double along = direction[axis] * step_m_;
        if (std::abs(along) * slices_ < slack * step_m_) {
            if (low > 0 || high < 0) return;
            continue;
        }
        const double a = low / along;
        const double b = high / along;
        first = std::max(first, std::min(a, b) - slack);
        last = std::min(last, std::max(a, b) + slack);
    }
    const int end = std::min(static_cast<int>(std::floor(last)), slices_ - 1);
    for (int k = static_cast<int>(std::floor(first)); k <= end; ++k) {
        words[static_cast<std::size_t>(k) / 64] |= std::uint64_t{1} << (k % 64);
    }
}

bool SliceMask::fill_band(int tile_row, std::vector<std::uint64_t>& words) const {
    words.assign(static_cast<std::size_t>(tiles_across_) * words_per_tile_, 0);
    const double top = tile_row * tile_edge;
    const double bottom = top + tile_edge;
    bool any = false;
    for (const Box& box : boxes_) {
        if (box.bottom < top || box.top > bottom) continue;
        const double last_tile = tiles_across_ - 1;
        const int from = static_cast<int>(std::clamp(box.left / tile_edge, 0.0, last_tile + 1));
        const int to =
            static_cast<int>(std::floor(std::clamp(box.right / tile_edge, -1.0, last_tile)));
        for (int tile = from; tile <= to; ++tile) {
            any = true;
            mark(box, tile_row, tile,
                 words.data() + static_cast<std::size_t>(tile) * words_per_tile_);
        }
    }
    return any;
}

}  // namespace stormcellar::render
