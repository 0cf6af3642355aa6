#include "render/animation/frame_change.h"

#include <algorithm>

namespace stormcellar::render {

Rectangle changed_rectangle(std::span<const std::uint8_t> before,
                            std::span<const std::uint8_t> after, int width, int height,
                            std::size_t pixel_bytes) {
    const std::size_t stride = static_cast<std::size_t>(width) * pixel_bytes;
    int top = height, bottom = -1, left = width, right = -1;
    for (int y = 0; y < height; ++y) {
        const auto row_before = before.subspan(static_cast<std::size_t>(y) * stride, stride);
        const auto row_after = after.subspan(static_cast<std::size_t>(y) * stride, stride);
        const auto first = std::ranges::mismatch(row_before, row_after).in1;
        if (first == row_before.end()) continue;
        const auto last =
            std::mismatch(row_before.rbegin(), row_before.rend(), row_after.rbegin()).first;
        const auto first_byte = static_cast<std::size_t>(first - row_before.begin());
        const auto last_byte = stride - 1 - static_cast<std::size_t>(last - row_before.rbegin());
        left = std::min(left, static_cast<int>(first_byte / pixel_bytes));
        right = std::max(right, static_cast<int>(last_byte / pixel_bytes));
        top = std::min(top, y);
        bottom = y;
    }
    if (bottom < 0) return {0, 0, 1, 1};
    return {left, top, right - left + 1, bottom - top + 1};
}

}  // namespace stormcellar::render
