#include "render/products/water_rows.h"

#include <algorithm>
#include <cmath>

namespace stormcellar::render {
namespace {

constexpr int block_edge = 16;   // cells
constexpr std::size_t run = 16;  // pixels
constexpr int most_blocks = 16;  // under a run; if there are more, the run is taken pixel by pixel

int blocks_along_edge(int cells) {
    return (cells + block_edge - 1) / block_edge;
}

// The first and the last block along an axis that hold the cells around the places from `least` to
// `most`.
struct BlockSpan {
    int first, last;
};
BlockSpan blocks_between(double least, double most, int cells) {
    const double end = cells - 1.0;
    const int first = static_cast<int>(std::clamp(least, 0.0, end));
    const int last = std::min(static_cast<int>(std::clamp(most, 0.0, end)) + 1, cells - 1);
    return {first / block_edge, last / block_edge};
}

}  // namespace

WaterRows::WaterRows(const WaterMask& mask)
    : mask_(mask),
      across_(blocks_along_edge(mask.width)),
      down_(blocks_along_edge(mask.height)),
      blocks_(static_cast<std::size_t>(across_) * static_cast<std::size_t>(down_)) {
    for (int by = 0; by < down_; ++by) {
        for (int bx = 0; bx < across_; ++bx) {
            const int left = bx * block_edge;
            const int right = std::min(left + block_edge, mask.width);
            const auto row = [&](int y) {
                return mask.water.data() +
                       static_cast<std::size_t>(y) * static_cast<std::size_t>(mask.width);
            };
            const std::uint8_t first = row(by * block_edge)[left];
            bool is_plain = true;
            for (int y = by * block_edge; y < std::min((by + 1) * block_edge, mask.height); ++y) {
                is_plain =
                    is_plain && std::all_of(row(y) + left, row(y) + right,
                                            [&](std::uint8_t cell) { return cell == first; });
            }
            block(bx, by) = is_plain ? std::int16_t{first} : shore;
        }
    }
}

std::int16_t WaterRows::common(const WaterRow& row, std::size_t first, std::size_t end) const {
    double west = row.x[first], east = west, north = row.y[first], south = north;
    for (std::size_t i = first; i < end; ++i) {
        west = std::min(west, row.x[i]);
        east = std::max(east, row.x[i]);
        north = std::min(north, row.y[i]);
        south = std::max(south, row.y[i]);
    }
    const auto [left, right] = blocks_between(west, east, mask_.width);
    const auto [top, bottom] = blocks_between(north, south, mask_.height);
    if ((right - left + 1) * (bottom - top + 1) > most_blocks) return shore;
    const auto at = [&](int bx, int by) {
        return blocks_[static_cast<std::size_t>(by) * static_cast<std::size_t>(across_) +
                       static_cast<std::size_t>(bx)];
    };
    const std::int16_t all = at(left, top);
    for (int by = top; by <= bottom; ++by) {
        for (int bx = left; bx <= right; ++bx) {
            if (at(bx, by) != all) return shore;
        }
    }
    return all;
}

void WaterRows::find(const GroundRow& row, WaterRow& found) const {
    const std::size_t width = row.x_m.size();
    found.share.resize(width);
    found.x.resize(width);
    found.y.resize(width);
    for (std::size_t i = 0; i < width; ++i)
        found.x[i] = (row.x_m[i] - mask_.west_m) / mask_.metres_per_cell - 0.5;
    for (std::size_t i = 0; i < width; ++i)
        found.y[i] = (mask_.north_m - row.y_m[i]) / mask_.metres_per_cell - 0.5;
    for (std::size_t first = 0; first < width; first += run) {
        const std::size_t end = std::min(first + run, width);
        // If part of the run is sky, the places of its pixels there are NaN, and no box holds them.
        const bool has_sky = std::any_of(row.x_m.begin() + static_cast<std::ptrdiff_t>(first),
                                         row.x_m.begin() + static_cast<std::ptrdiff_t>(end),
                                         [](double x_m) { return std::isnan(x_m); });
        const std::int16_t all = has_sky ? shore : common(found, first, end);
        for (std::size_t i = first; i < end; ++i) {
            if (all != shore) {
                found.share[i] = all / 255.0;
            } else if (!row.is_sky(i)) {
                found.share[i] = mask_.share_at(found.x[i], found.y[i]);
            }
        }
    }
}

}  // namespace stormcellar::render
