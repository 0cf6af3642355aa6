#include "render/volume/slice_mask.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>
#include <utility>

#include "base/parallel.h"
#include "render/volume/block_codes.h"

namespace stormcellar::render {
namespace {

using grid::brick_edge;

// A bit may be set this many steps too early or too late. This covers the rounding on both sides.
constexpr double slack = 0.01;

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

// Returns the edge of the blocks. Blocks about as wide as a tile of the picture are fine enough.
// Smaller or more blocks take more time than they save.
int block_edge_for(const grid::GridSpec& spec, const ViewGeometry& geometry) {
    constexpr double most_blocks = 1 << 18;
    const double cell_m = std::min(spec.cell_width_m(), spec.cell_height_m());
    const auto cells = static_cast<double>(spec.cell_count());
    int edge = 2;
    while (edge < brick_edge &&
           (cells / (edge * edge * edge) > most_blocks ||
            2 * edge * cell_m <= 1.5 * tile_edge * geometry.metres_per_pixel()))
        edge *= 2;
    return edge;
}

// Computes the interval along one axis that is colored by the cells from `first` to before `past`.
// Values are interpolated between cells, so the interval extends to the centers of the neighboring
// cells, or to the edge of the box if there are no neighbors.
template <class Centre>
void reach(int first, int past, int cells, double edge_low, double edge_high, Centre centre,
           double& low, double& high) {
    low = first == 0 ? edge_low : centre(first - 1);
    high = past >= cells ? edge_high : centre(past);
}

}  // namespace

// A range of cells: along each axis from `first` to before `past`.
struct SliceMask::Cells {
    int first[3], past[3];
};

SliceMask::SliceMask(const grid::BrickView& view, const ViewGeometry& geometry, int slices,
                     const TransferFunction& transfer, int threads, int edge)
    : geometry_(geometry),
      slices_(slices),
      edge_(edge),
      step_m_((geometry.far_m() - geometry.near_m()) / slices),
      tiles_across_((geometry.width() + edge - 1) / edge),
      tiles_down_((geometry.height() + edge - 1) / edge),
      words_per_tile_(static_cast<std::size_t>(slices + 63) / 64),
      block_edge_(block_edge_for(*view.spec, geometry)),
      boxes_(static_cast<std::size_t>(view.bricks_x)),
      row_ends_(static_cast<std::size_t>(tiles_down_)) {
    // Sort the boxes into the rows of tiles that they reach. Two passes do this, so that the list
    // needs no locks and does not depend on the number of threads. The first pass finds the boxes
    // of each slab of bricks, and counts them for each row.
    const auto rows = static_cast<std::size_t>(tiles_down_);
    std::vector<std::size_t> places(boxes_.size() * rows);
    for_each_piece(view.bricks_x, threads, [&](int bx) {
        const auto slab = static_cast<std::size_t>(bx);
        for (int by = 0; by < view.bricks_y; ++by) {
            for (int bz = 0; bz < view.bricks_z; ++bz)
                add_brick(view, transfer, {bx, by, bz}, boxes_[slab]);
        }
        for (const Box& box : boxes_[slab]) {
            for (int row = box.first_row; row <= box.last_row; ++row)
                ++places[slab * rows + static_cast<std::size_t>(row)];
        }
    });
    // Turn the counts into the places at which each slab writes its boxes into the list of each
    // row.
    std::size_t count = 0;
    for (std::size_t row = 0; row < rows; ++row) {
        for (std::size_t slab = 0; slab < boxes_.size(); ++slab)
            count += std::exchange(places[slab * rows + row], count);
        row_ends_[row] = count;
    }
    in_rows_.resize(count);
    // In the second pass, write the numbers of the boxes to these places.
    for_each_piece(view.bricks_x, threads, [&](int bx) {
        const auto slab = static_cast<std::size_t>(bx);
        const Boxes& boxes = boxes_[slab];
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            for (int row = boxes[i].first_row; row <= boxes[i].last_row; ++row) {
                in_rows_[places[slab * rows + static_cast<std::size_t>(row)]++] = {
                    static_cast<std::uint32_t>(slab), static_cast<std::uint32_t>(i)};
            }
        }
    });
}

// Adds boxes for the visible parts of a brick. The codes of the whole brick rule out most bricks,
// so the codes of blocks are computed only for the other bricks.
void SliceMask::add_brick(const grid::BrickView& view, const TransferFunction& transfer,
                          const std::array<int, 3>& brick, Boxes& boxes) const {
    const std::size_t index = view.brick_index(brick[0], brick[1], brick[2]);
    const grid::BrickEntry& entry = view.bricks[index];
    if (entry.kind != grid::BrickKind::stored || entry.value_count == 0) return;
    if (!transfer.shows(entry.min_code, entry.max_code)) return;
    const auto bytes = static_cast<std::size_t>(view.quantization.code_bytes);
    BlockCodes codes;
    find_block_codes(view.codes.data() + index * grid::brick_cells * bytes,
                     view.quantization.code_bytes, block_edge_, codes);
    const auto shows = [&](int block) {
        const auto at = static_cast<std::size_t>(block);
        return codes.largest[at] >= grid::first_value_code &&
               transfer.shows(codes.least[at], codes.largest[at]);
    };
    // Visible blocks on top of each other make one box.
    const int across = codes.across;
    for (int column = 0; column < across * across; ++column) {
        for (int z = 0; z < across; ++z) {
            if (!shows(column * across + z)) continue;
            const int first = z;
            while (z + 1 < across && shows(column * across + z + 1))
                ++z;
            Cells cells{};
            cells.first[0] = brick[0] * brick_edge + column / across * block_edge_;
            cells.first[1] = brick[1] * brick_edge + column % across * block_edge_;
            cells.first[2] = brick[2] * brick_edge + first * block_edge_;
            cells.past[0] = cells.first[0] + block_edge_;
            cells.past[1] = cells.first[1] + block_edge_;
            cells.past[2] = brick[2] * brick_edge + (z + 1) * block_edge_;
            add_cells(*view.spec, cells, boxes);
        }
    }
}

// Makes the box of a range of cells in drawn space: its extent along each axis, lowered by the
// drawn curve of the earth, times the vertical exaggeration.
void SliceMask::add_cells(const grid::GridSpec& spec, const Cells& cells, Boxes& boxes) const {
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
    // The curve lowers the box least where the box is nearest to the middle of the grid, and most
    // where the box is farthest from the middle.
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
    if (place_in_picture(box)) boxes.push_back(box);
}

// The place of a box in the picture, in pixels, and the distance of the box's farthest corner.
struct SliceMask::Outline {
    double left, right, top, bottom, farthest_m;

    void add(const Pixel& p) {
        left = std::min(left, p.x);
        right = std::max(right, p.x);
        top = std::min(top, p.y);
        bottom = std::max(bottom, p.y);
    }
};

// Uses parallel rays, for which the outline of a box is as wide as the projections of its three
// edges together.
SliceMask::Outline SliceMask::parallel_outline(const Box& box) const {
    Vec3 middle{};
    double across = 0, down = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        middle[axis] = 0.5 * (box.low[axis] + box.high[axis]);
        const double half = 0.5 * (box.high[axis] - box.low[axis]);
        across += half * std::abs(geometry_.right()[axis]);
        down += half * std::abs(geometry_.up()[axis]);
    }
    const Pixel p = geometry_.project(middle);
    const double per_pixel = geometry_.metres_per_pixel();
    return {p.x - across / per_pixel, p.x + across / per_pixel, p.y - down / per_pixel,
            p.y + down / per_pixel, 0};
}

SliceMask::Outline SliceMask::perspective_outline(const Box& box) const {
    constexpr double far_off = 1e9;
    Outline outline{far_off, -far_off, far_off, -far_off, -std::numeric_limits<double>::infinity()};
    bool behind = false;
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3 point = {(corner & 1) != 0 ? box.high[0] : box.low[0],
                            (corner & 2) != 0 ? box.high[1] : box.low[1],
                            (corner & 4) != 0 ? box.high[2] : box.low[2]};
        const double depth = geometry_.depth_of(point);
        outline.farthest_m = std::max(outline.farthest_m, depth);
        if (depth < geometry_.near_m()) {
            behind = true;
        } else {
            outline.add(geometry_.project(point));
        }
    }
    // The camera is in the box or beside it, so the box may be anywhere in the picture.
    if (behind) {
        outline.add({0, 0});
        outline.add({1.0 * geometry_.width(), 1.0 * geometry_.height()});
    }
    return outline;
}

// Finds the tiles and rows of the box, and widens the box by half a tile on each side. Then one ray
// through the middle of a tile decides for the whole tile: if it misses the widened box, all rays
// of the tile miss the box. Returns false if the box is outside the picture or behind the camera.
bool SliceMask::place_in_picture(Box& box) const {
    const Outline outline =
        geometry_.is_perspective() ? perspective_outline(box) : parallel_outline(box);
    if (geometry_.is_perspective() && outline.farthest_m < geometry_.near_m()) return false;
    const auto tile = [&](double pixel, int tiles) {
        return static_cast<int>(std::floor(std::clamp(pixel / edge_, -1.0, 1.0 * tiles)));
    };
    box.first_tile = std::max(tile(outline.left, tiles_across_), 0);
    box.last_tile = std::min(tile(outline.right, tiles_across_), tiles_across_ - 1);
    box.first_row = std::max(tile(outline.top, tiles_down_), 0);
    box.last_row = std::min(tile(outline.bottom, tiles_down_), tiles_down_ - 1);
    const double half = 0.5 * edge_ * geometry_.metres_per_pixel(outline.farthest_m);
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

// Sets the bits of the steps in which the ray through the middle of the tile is inside the widened
// box. For each axis, the ray is between a pair of planes from one depth to another; it is inside
// the box at the depths that all three axes have in common.
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
    const auto row = static_cast<std::size_t>(tile_row);
    const std::size_t begin = row == 0 ? 0 : row_ends_[row - 1];
    const auto in_row = std::span(in_rows_).subspan(begin, row_ends_[row] - begin);
    if (in_row.empty()) return false;
    words.assign(static_cast<std::size_t>(tiles_across_) * words_per_tile_, 0);
    const auto middle = [&](int tile) {
        return Pixel{(tile + 0.5) * edge_, (tile_row + 0.5) * edge_};
    };
    const Vec3 start = geometry_.point(middle(0), geometry_.near_m());
    const Vec3 next = geometry_.point(middle(1), geometry_.near_m());
    const Vec3 per_tile = {next[0] - start[0], next[1] - start[1], next[2] - start[2]};
    const Direction parallel = direction(geometry_.forward());
    for (const BoxNumber& number : in_row) {
        const Box& box = boxes_[number.slab][number.box];
        for (int tile = box.first_tile; tile <= box.last_tile; ++tile) {
            const Vec3 from = {start[0] + tile * per_tile[0], start[1] + tile * per_tile[1],
                               start[2] + tile * per_tile[2]};
            mark(box, from,
                 geometry_.is_perspective() ? direction(geometry_.along(middle(tile))) : parallel,
                 words.data() + static_cast<std::size_t>(tile) * words_per_tile_);
        }
    }
    return true;
}

}  // namespace stormcellar::render
