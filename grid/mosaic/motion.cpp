#include "grid/mosaic/motion.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/parallel.h"
#include "grid/mosaic/echo_image.h"
#include "grid/mosaic/image_match.h"

namespace stormcellar::grid {
namespace {

// Pixels of 4 km; with fewer, the motion of the whole is unknown.
constexpr std::size_t fewest_pixels = 200;
constexpr std::size_t fewest_in_block = 40;
constexpr double worthless_correlation = 0.3;

// The motion of a block or of the whole image. Its weight says how much it counts.
struct Vote {
    double x = 0, y = 0;  // pixels
    double weight = 0;
};

int reach_of(double speed_mps, double seconds, double pixel_m) {
    return static_cast<int>(std::ceil(speed_mps * seconds / pixel_m));
}

struct Images {
    EchoImage before, after;                // their pixels are pixel_m wide
    EchoImage coarse_before, coarse_after;  // their pixels are twice as wide
    double pixel_width_m = 0, pixel_height_m = 0;
};

Images images_of(const BrickView& before, const BrickView& after, const MotionOptions& options) {
    const GridSpec& spec = *before.spec;
    EchoImageOptions image;
    const double column_m = std::min(spec.cell_width_m(), spec.cell_height_m());
    image.cells = std::max(1, static_cast<int>(std::lround(options.pixel_m / column_m)));
    Images images;
    images.before = echo_image(before, image);
    images.after = echo_image(after, image);
    images.coarse_before = halved(images.before);
    images.coarse_after = halved(images.after);
    images.pixel_width_m = spec.cell_width_m() * image.cells;
    images.pixel_height_m = spec.cell_height_m() * image.cells;
    return images;
}

// Returns the motion of the whole image, in pixels of the fine images.
std::optional<Vote> motion_of_whole(const Images& images, double seconds,
                                    const MotionOptions& options) {
    const EchoImage& before = images.coarse_before;
    const ShiftSearch search{0, 0,
                             reach_of(options.greatest_mps, seconds, 2 * images.pixel_width_m),
                             reach_of(options.greatest_mps, seconds, 2 * images.pixel_height_m)};
    const auto shift =
        best_shift(before, images.coarse_after, {0, 0, before.width, before.height}, search);
    if (!shift || shift->pixels < fewest_pixels || shift->correlation < worthless_correlation) {
        return std::nullopt;
    }
    return Vote{2 * shift->x, 2 * shift->y, 1};
}

// The blocks of an image. They overlap by half, and their middles are the nodes of the motion
// field.
struct Blocks {
    int width = 0, height = 0;
    int step = 0;  // pixels from one middle to the next, half the width of a block

    [[nodiscard]] std::size_t index(int column, int row) const {
        const int before = row * width + column;
        return static_cast<std::size_t>(before);
    }
};

Blocks blocks_of(const EchoImage& image, double block_pixels) {
    Blocks blocks;
    blocks.step = std::max(4, static_cast<int>(std::lround(block_pixels / 2)));
    blocks.width = (image.width + blocks.step - 1) / blocks.step + 1;
    blocks.height = (image.height + blocks.step - 1) / blocks.step + 1;
    return blocks;
}

Vote vote_of_block(const Images& images, const Blocks& blocks, int column, int row,
                   const ShiftSearch& search) {
    const int x = column * blocks.step, y = row * blocks.step;
    const PixelBox box{std::max(0, x - blocks.step), std::max(0, y - blocks.step),
                       std::min(images.before.width, x + blocks.step),
                       std::min(images.before.height, y + blocks.step)};
    const auto shift = best_shift(images.before, images.after, box, search);
    if (!shift || shift->pixels < fewest_in_block || shift->correlation < worthless_correlation) {
        return {};
    }
    const double worth = shift->correlation - worthless_correlation;
    return {shift->x, shift->y, worth * worth * std::sqrt(static_cast<double>(shift->pixels))};
}

// Returns the mean of the votes of the blocks around a node, weighted by a Gaussian with a width of
// one step. The motion of the whole image has a small weight, so that it matters only where no
// block has a vote.
Vote smoothed(const std::vector<Vote>& votes, const Blocks& blocks, int column, int row,
              const Vote& whole) {
    constexpr double weight_of_whole = 0.02;
    Vote sum{whole.x * weight_of_whole, whole.y * weight_of_whole, weight_of_whole};
    for (int y = std::max(0, row - 3); y < std::min(blocks.height, row + 4); ++y) {
        for (int x = std::max(0, column - 3); x < std::min(blocks.width, column + 4); ++x) {
            const Vote& vote = votes[blocks.index(x, y)];
            const double apart = (x - column) * (x - column) + (y - row) * (y - row);
            const double weight = vote.weight * std::exp(-apart / 2);
            sum.x += weight * vote.x;
            sum.y += weight * vote.y;
            sum.weight += weight;
        }
    }
    return {sum.x / sum.weight, sum.y / sum.weight, sum.weight};
}

std::vector<Vote> votes_of(const Images& images, const Blocks& blocks, const ShiftSearch& search,
                           int threads) {
    std::vector<Vote> votes(static_cast<std::size_t>(blocks.width * blocks.height));
    for_each_piece(blocks.height, threads, [&](int row) {
        for (int column = 0; column < blocks.width; ++column) {
            votes[blocks.index(column, row)] = vote_of_block(images, blocks, column, row, search);
        }
    });
    return votes;
}

}  // namespace

MotionField::MotionField(CellMotion motion) : MotionField(1, 1, 1, {motion}, motion) {}

MotionField::MotionField(int width, int height, double step, std::vector<CellMotion> nodes,
                         CellMotion whole)
    : width_(width), height_(height), step_(step), nodes_(std::move(nodes)), whole_(whole) {
    for (const CellMotion& node : nodes_) {
        greatest_.x = std::max(greatest_.x, std::abs(node.x));
        greatest_.y = std::max(greatest_.y, std::abs(node.y));
    }
}

CellMotion MotionField::at(double ix, double iy) const {
    const double x = std::clamp(ix / step_, 0.0, static_cast<double>(width_ - 1));
    const double y = std::clamp(iy / step_, 0.0, static_cast<double>(height_ - 1));
    const int x0 = std::min(static_cast<int>(x), std::max(0, width_ - 2));
    const int y0 = std::min(static_cast<int>(y), std::max(0, height_ - 2));
    const auto node = [&](int column, int row) -> const CellMotion& {
        const int index = std::min(row, height_ - 1) * width_ + std::min(column, width_ - 1);
        return nodes_[static_cast<std::size_t>(index)];
    };
    const auto fx = static_cast<float>(x - x0), fy = static_cast<float>(y - y0);
    const CellMotion &a = node(x0, y0), &b = node(x0 + 1, y0), &c = node(x0, y0 + 1),
                     &d = node(x0 + 1, y0 + 1);
    return {(1 - fy) * ((1 - fx) * a.x + fx * b.x) + fy * ((1 - fx) * c.x + fx * d.x),
            (1 - fy) * ((1 - fx) * a.y + fx * b.y) + fy * ((1 - fx) * c.y + fx * d.y)};
}

Result<std::optional<MotionField>> estimate_motion(const BrickView& before, const BrickView& after,
                                                   double seconds, const MotionOptions& options) {
    if (*before.spec != *after.spec) {
        return fail(ErrorCode::bad_argument, "there is no motion between grids of different specs");
    }
    if (!std::isgreater(seconds, 0.0) || !std::isfinite(seconds)) {
        return fail(ErrorCode::bad_argument, "there is no motion within {} s", seconds);
    }
    const Images images = images_of(before, after, options);
    const auto whole = motion_of_whole(images, seconds, options);
    if (!whole) return std::optional<MotionField>{};

    const double block_pixels = options.block_m / images.pixel_height_m;
    const Blocks blocks = blocks_of(images.before, block_pixels);
    const ShiftSearch near{static_cast<int>(std::lround(whole->x)),
                           static_cast<int>(std::lround(whole->y)),
                           1 + reach_of(options.block_differs_mps, seconds, images.pixel_width_m),
                           1 + reach_of(options.block_differs_mps, seconds, images.pixel_height_m)};
    const std::vector<Vote> votes = votes_of(images, blocks, near, options.threads);
    const int cells = images.before.cells;
    // The search covers whole pixels, so it may find motions that are faster than the options
    // allow.
    const double fastest_mps = options.greatest_mps + options.block_differs_mps;
    const auto columns_per_s = [&](double pixels, double pixel_m) {
        const double most = fastest_mps * cells / pixel_m;
        return static_cast<float>(std::clamp(pixels * cells / seconds, -most, most));
    };
    const auto motion_of = [&](const Vote& vote) {
        return CellMotion{columns_per_s(vote.x, images.pixel_width_m),
                          columns_per_s(vote.y, images.pixel_height_m)};
    };
    std::vector<CellMotion> nodes;
    for (int row = 0; row < blocks.height; ++row) {
        for (int column = 0; column < blocks.width; ++column) {
            nodes.push_back(motion_of(smoothed(votes, blocks, column, row, *whole)));
        }
    }
    return std::optional<MotionField>{MotionField(blocks.width, blocks.height, blocks.step * cells,
                                                  std::move(nodes), motion_of(*whole))};
}

}  // namespace stormcellar::grid
