#include "tests/images/picture_difference.h"

#include <algorithm>
#include <vector>

#include "render/color/color_difference.h"

namespace stormcellar::images {
namespace {

using render::Image;
using render::Rgba8;

constexpr int tile_edge = 8;

// Replaces each pixel by the mean of this pixel and its neighbors.
Image softened(const Image& image) {
    Image soft(image.width, image.height, {0, 0, 0, 255});
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            int sums[3] = {};
            int count = 0;
            for (int ny = std::max(0, y - 1); ny <= std::min(image.height - 1, y + 1); ++ny) {
                for (int nx = std::max(0, x - 1); nx <= std::min(image.width - 1, x + 1); ++nx) {
                    const Rgba8 pixel = image.at(nx, ny);
                    for (std::size_t i = 0; i < 3; ++i)
                        sums[i] += pixel[i];
                    ++count;
                }
            }
            Rgba8 mean{0, 0, 0, 255};
            for (std::size_t i = 0; i < 3; ++i)
                mean[i] = static_cast<std::uint8_t>((sums[i] + count / 2) / count);
            soft.set(x, y, mean);
        }
    }
    return soft;
}

// Returns the difference of each pixel of the softened pictures, row by row.
std::vector<double> differences(const Image& one, const Image& other) {
    const Image a = softened(one);
    const Image b = softened(other);
    std::vector<double> found;
    found.reserve(static_cast<std::size_t>(a.width) * static_cast<std::size_t>(a.height));
    for (int y = 0; y < a.height; ++y) {
        for (int x = 0; x < a.width; ++x) {
            const bool same = a.at(x, y) == b.at(x, y);
            found.push_back(same ? 0 : render::color_difference(a.at(x, y), b.at(x, y)));
        }
    }
    return found;
}

}  // namespace

Result<PictureDifference> difference_of(const Image& one, const Image& other) {
    if (one.width != other.width || one.height != other.height || one.rgba.empty()) {
        return fail(ErrorCode::bad_argument, "pictures of different sizes, or none");
    }
    const std::vector<double> found = differences(one, other);
    PictureDifference result;
    std::size_t seen = 0;
    for (const double difference : found)
        seen += difference > visible ? 1 : 0;
    result.visible_share = static_cast<double>(seen) / static_cast<double>(found.size());
    for (int top = 0; top < one.height; top += tile_edge) {
        for (int left = 0; left < one.width; left += tile_edge) {
            double sum = 0;
            int count = 0;
            for (int y = top; y < std::min(top + tile_edge, one.height); ++y) {
                for (int x = left; x < std::min(left + tile_edge, one.width); ++x, ++count)
                    sum += found[static_cast<std::size_t>(y) * static_cast<std::size_t>(one.width) +
                                 static_cast<std::size_t>(x)];
            }
            if (sum / count > result.worst_tile) {
                result.worst_tile = sum / count;
                result.tile_x = left;
                result.tile_y = top;
            }
        }
    }
    std::vector<double> sorted = found;
    const auto place = sorted.begin() + static_cast<std::ptrdiff_t>((sorted.size() - 1) * 99 / 100);
    std::nth_element(sorted.begin(), place, sorted.end());
    result.percentile_99 = *place;
    return result;
}

bool within(const PictureDifference& difference, const Tolerance& tolerance) {
    return difference.percentile_99 <= tolerance.percentile_99 &&
           difference.visible_share <= tolerance.visible_share &&
           difference.worst_tile <= tolerance.worst_tile;
}

Image picture_of_difference(const Image& one, const Image& other) {
    const std::vector<double> found = differences(one, other);
    Image picture(one.width, one.height, {0, 0, 0, 255});
    std::size_t i = 0;
    for (int y = 0; y < one.height; ++y) {
        for (int x = 0; x < one.width; ++x, ++i) {
            const Rgba8 pixel = one.at(x, y);
            const int grey = 128 + (pixel[0] + 2 * pixel[1] + pixel[2]) / 8;
            const auto light = static_cast<std::uint8_t>(std::min(grey, 255));
            const double share = found[i] > visible ? std::min(1.0, 0.4 + found[i] / 30) : 0;
            const auto rest = static_cast<std::uint8_t>(light * (1 - share));
            const auto red = static_cast<std::uint8_t>(rest + 220 * share);
            picture.set(x, y, {red, rest, rest, 255});
        }
    }
    return picture;
}

}  // namespace stormcellar::images
