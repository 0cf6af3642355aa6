// stormcellar/render/image.h -- an image as pixels.
//
// Threads   Plain data; any thread may read it while no thread writes it.
// Errors    None; pixels must be within the image.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

namespace stormcellar::render {

using Rgba8 = std::array<std::uint8_t, 4>;  // sRGB; alpha is not premultiplied

// Returns the color that results from drawing `color` over the opaque color `below`.
[[nodiscard]] Rgba8 over(const Rgba8& color, const Rgba8& below);

// Pixels in rows; row 0 is the top. All pixels are opaque unless stated otherwise.
struct Image {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgba;  // width * height * 4, R G B A

    Image() = default;
    Image(int w, int h, Rgba8 fill);
    // Returns the color of a pixel, which must exist.
    [[nodiscard]] Rgba8 at(int x, int y) const {
        const std::size_t first = offset(x, y);
        return {rgba[first], rgba[first + 1], rgba[first + 2], rgba[first + 3]};
    }
    void set(int x, int y, Rgba8 color) {
        std::memcpy(rgba.data() + offset(x, y), color.data(), color.size());
    }

  private:
    [[nodiscard]] std::size_t offset(int x, int y) const {
        return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                static_cast<std::size_t>(x)) *
               4;
    }
};

}  // namespace stormcellar::render
