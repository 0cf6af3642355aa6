// render/animation/frame_change.h -- finds the part of a frame that differs from the frame before.
//
// Threads   A pure function.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace stormcellar::render {

struct Rectangle {
    int x = 0, y = 0, width = 0, height = 0;
    bool operator==(const Rectangle&) const = default;
};

// Returns the smallest rectangle that holds all pixels that differ. If none differs, returns the
// pixel at the top left, because no format has an empty frame. Both spans hold width * height *
// pixel_bytes bytes.
[[nodiscard]] Rectangle changed_rectangle(std::span<const std::uint8_t> before,
                                          std::span<const std::uint8_t> after, int width,
                                          int height, std::size_t pixel_bytes);

}  // namespace stormcellar::render
