#include "render/volume/slice_mask.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

namespace stormcellar::render {
namespace {

using grid::brick_edge;

// Steps by which a bit may be set too early or too late: covers the rounding of both sides.
constexpr double slack = 0.01;
constexpr int block_edge = brick_edge / 2;
constexpr double half_tile_pixels = 0.5 * tile_edge;

// Sets the bits from `first` to `last`, both included.
void set_bits(std::uint64_t* words, int first, int last) {
    const auto from = static_cast<std::size_t>(first);
    const auto to = static_cast<std::size_t>(last);
    const std::uint64_t head = ~std::uint64_t{0} << (from % 64);
    const std::uint64_t tail = ~std::uint64_t{0} >> (63 - to % 64);
    if (from / 64 == to / 64) {
        words[from / 64] |= head & tail;
        return;
    }
    words[from / 64] |= head;
    for (std::size_t w = from / 64 + 1; w < to / 64; ++w)
        words[w] = ~std::uint64_t{0};
    words[to / 64] |= tail;
}

// Least and largest code of the values in each block of a brick; blocks without have least >
// largest. Block 4 x + 2 y + z.
struct BlockCodes {
    std::array<std::uint16_t, 8> least{}, largest{};
};

// Codes of states, less the first of a value, wrap to the top, where no value is.
template <class Code>
BlockCodes block_codes(const std::byte* codes) {
    constexpr auto states = static_cast<Code>(grid::first_value_code);
    BlockCodes found;
    for (int half = 0; half < 4; ++half) {
        std::array<Code, brick_edge> least{}, largest{};
        least.fill(std::numeric_limits<Code>::max());
        for (int x = 0; x < block_edge; ++x) {
            for (int y = 0; y < block_edge; ++y) {
                const int row =
                    ((half / 2) * block_edge + x) * brick_edge + (half % 2) * block_edge + y;
                std::array<Code, brick_edge> cells;
                std::memcpy(cells.data(), codes + static_cast<std::size_t>(row) * sizeof cells,
                            sizeof cells);
                for (std::size_t z = 0; z < cells.size(); ++z) {
                    const auto value = static_cast<Code>(cells[z] - states);
                    least[z] = std::min(least[z], value);
                    largest[z] = std::max(largest[z], cells[z]);
                }
            }
        }
        for (std::size_t z = 0; z < 2; ++z) {
            const auto from = static_cast<std::ptrdiff_t>(z) * block_edge;
            const auto block = static_cast<std::size_t>(half) * 2 + z;
            found.least[block] = static_cast<std::uint16_t>(
                *std::min_element(least.begin() + from, least.begin() + from + block_edge) +
                states);
            found.largest[block] =
                *std::max_element(largest.begin() + from, largest.begin() + from + block_edge);
        }
    }
    return found;
}

// The stretch along one axis that the cells from `first` to before `past` colour: up to the centres
// of the neighbours' nearest cells, or to the box's edge where there are none.
template <class Centre>
void reach(int first, int past, int cells, double edge_low, double edge_high, Centre centre,
           double& low, double& high) {
    low = first == 0 ? edge_low : centre(first - 1);
    high = past >= cells ? edge_high : centre(past);
}

}  // namespace

// Cells of a grid, from the first to before the last along each axis.
struct SliceMask::Cells {
    int first[3], past[3];
};

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
                    add_brick(view, transfer, bx, by, bz);
                }
            }
        }
    }
}

void SliceMask::add_brick(const grid::BrickView& view, const TransferFunction& transfer, int bx,
                          int by, int bz) {
    const int bytes = view.quantization.code_bytes;
    const std::byte* codes = view.codes.data() + view.brick_index(bx, by, bz) * grid::brick_cells *
                                                     static_cast<std::size_t>(bytes);
    const BlockCodes blocks =
        bytes == 1 ? block_codes<std::uint8_t>(codes) : block_codes<std::uint16_t>(codes);
    std::array<bool, 8> shows{};
    for (std::size_t block = 0; block < shows.size(); ++block) {
        shows[block] = blocks.largest[block] >= grid::first_value_code &&
                       transfer.shows(blocks.least[block], blocks.largest[block]);
    }
    const grid::GridSpec& spec = *view.spec;
    const Cells brick = {{bx * brick_edge, by * brick_edge, bz * brick_edge},
                         {(bx + 1) * brick_edge, (by + 1) * brick_edge, (bz + 1) * brick_edge}};
    if (std::all_of(shows.begin(), shows.end(), [](bool show) { return show; })) {
        return add_cells(spec, brick);
    }
    for (std::size_t block = 0; block < shows.size(); ++block) {
        if (!shows[block]) continue;
        Cells cells = brick;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            cells.first[axis] += (block >> (2 - axis) & 1) != 0 ? block_edge : 0;
            cells.past[axis] = cells.first[axis] + block_edge;
        }
        add_cells(spec, cells);
    }
}

void SliceMask::add_cells(const grid::GridSpec& spec, const Cells& cells) {
    Box box{};
    reach(
        cells.first[0], cells.past[0], spec.nx, -geometry_.half_x_m(), geometry_.half_x_m(),
        [&](int i) { return spec.x_from_middle_m(i); }, box.low[0], box.high[0]);
    reach(
        cells.first[1], cells.past[1], spec.ny, -geometry_.half_y_m(), geometry_.half_y_m(),
        [&](int i) { return spec.y_from_middle_m(i); }, box.low[1], box.high[1]);
    reach(
        cells.first[2], cells.past[2], spec.nz(), geometry_.bottom_m(), geometry_.top_m(),
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
    if (place_in_picture(box)) boxes_.push_back(box);
}

// False for a box beside the picture, or behind the camera.
bool SliceMask::place_in_picture(Box& box) const {
    constexpr double far_off = 1e9;
    double left = far_off, right = -far_off, top = far_off, bottom = -far_off;
    double farthest = -std::numeric_limits<double>::infinity();
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
        left = std::min(left, p.x);
        right = std::max(right, p.x);
        top = std::min(top, p.y);
        bottom = std::max(bottom, p.y);
    }
    if (geometry_.is_perspective() && farthest < geometry_.near_m()) return false;
    if (behind) {  // the camera is in the box or beside it: it may be anywhere in the picture
        left = top = 0;
        right = geometry_.width();
        bottom = geometry_.height();
    }
    const auto tile = [](double pixel, int tiles) {
        return static_cast<int>(std::floor(std::clamp(pixel / tile_edge, -1.0, 1.0 * tiles)));
    };
    box.first_tile = std::max(tile(left, tiles_across_), 0);
    box.last_tile = std::min(tile(right, tiles_across_), tiles_across_ - 1);
    box.first_row = std::max(tile(top, tiles_down_), 0);
    box.last_row = std::min(tile(bottom, tiles_down_), tiles_down_ - 1);
    const double half = half_tile_pixels * geometry_.metres_per_pixel(farthest);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double widen =
            half * (std::abs(geometry_.right()[axis]) + std::abs(geometry_.up()[axis])) +
            slack * step_m_;
        box.low[axis] -= widen;
        box.high[axis] += widen;
    }
    return box.first_tile <= box.last_tile && box.first_row <= box.last_row;
}

SliceMask::Direction SliceMask::direction(const Vec3& along) const {
    Direction direction{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        direction.moves[axis] = std::abs(along[axis]) * slices_ >= slack;
        if (direction.moves[axis]) direction.per_step[axis] = 1 / (along[axis] * step_m_);
    }
    return direction;
}

// Cuts the ray through the tile's middle with the widened box.
void SliceMask::mark(const Box& box, const Vec3& start, const Direction& direction,
                     std::uint64_t* words) const {
    double first = 0;
    double last = slices_;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double low = box.low[axis] - start[axis];
        const double high = box.high[axis] - start[axis];
        if (!direction.moves[axis]) {
            if (low > 0 || high < 0) return;
            continue;
        }
        const double a = low * direction.per_step[axis];
        const double b = high * direction.per_step[axis];
        first = std::max(first, std::min(a, b) - slack);
        last = std::min(last, std::max(a, b) + slack);
    }
    const int begin = static_cast<int>(first);
    const int end = last < 0 ? -1 : std::min(static_cast<int>(last), slices_ - 1);
    if (begin <= end) set_bits(words, begin, end);
}

bool SliceMask::fill_band(int tile_row, std::vector<std::uint64_t>& words) const {
    words.assign(static_cast<std::size_t>(tiles_across_) * words_per_tile_, 0);
    const auto middle = [&](int tile) {
        return Pixel{tile * tile_edge + half_tile_pixels, tile_row * tile_edge + half_tile_pixels};
    };
    const Vec3 start = geometry_.point(middle(0), geometry_.near_m());
    const Vec3 next = geometry_.point(middle(1), geometry_.near_m());
    const Vec3 per_tile = {next[0] - start[0], next[1] - start[1], next[2] - start[2]};
    const Direction parallel = direction(geometry_.forward());
    bool any = false;
    for (const Box& box : boxes_) {
        if (box.first_row > tile_row || box.last_row < tile_row) continue;
        any = true;
        for (int tile = box.first_tile; tile <= box.last_tile; ++tile) {
            const Vec3 from = {start[0] + tile * per_tile[0], start[1] + tile * per_tile[1],
                               start[2] + tile * per_tile[2]};
            mark(box, from,
                 geometry_.is_perspective() ? direction(geometry_.along(middle(tile))) : parallel,
                 words.data() + static_cast<std::size_t>(tile) * words_per_tile_);
        }
    }
    return any;
}

}  // namespace stormcellar::render
