#include "render/animation/palette.h"

#include <algorithm>
#include <cstdlib>
#include <set>

#include <gtest/gtest.h>

#include "tests/render/decoded_animation.h"

namespace stormcellar::render {
namespace {

// Returns a smooth image with 128 x 128 different colors.
Image gradient() {
    Image image(128, 128, {});
    for (int y = 0; y < 128; ++y) {
        for (int x = 0; x < 128; ++x) {
            image.set(x, y,
                      {static_cast<std::uint8_t>(2 * x), static_cast<std::uint8_t>(2 * y),
                       static_cast<std::uint8_t>(255 - x - y / 2), 255});
        }
    }
    return image;
}

int distance(Rgb8 a, Rgb8 b) {
    int largest = 0;
    for (std::size_t c = 0; c < 3; ++c)
        largest = std::max(largest, std::abs(a[c] - b[c]));
    return largest;
}

TEST(Palette, FewColorsAreKeptExactly) {
    ColorHistogram histogram;
    std::set<Rgb8> colors;
    for (const Image& frame : test_frames(4)) {
        histogram.add(frame);
        for (std::size_t i = 0; i < frame.rgba.size(); i += 4)
            colors.insert({frame.rgba[i], frame.rgba[i + 1], frame.rgba[i + 2]});
    }
    const auto palette = histogram.palette(255);
    EXPECT_EQ(std::set<Rgb8>(palette.begin(), palette.end()), colors);
}

TEST(Palette, ManyColorsAreAllNearAnEntry) {
    ColorHistogram histogram;
    const Image image = gradient();
    histogram.add(image);
    const auto palette = histogram.palette(255);
    EXPECT_LE(palette.size(), 255U);
    PaletteMap map(palette);
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
        const Rgb8 color{image.rgba[i], image.rgba[i + 1], image.rgba[i + 2]};
        EXPECT_LE(distance(palette[map.nearest(color)], color), 24);
    }
}

TEST(Palette, ColorOfTheBackgroundStaysExactAmongThousands) {
    ColorHistogram histogram;
    histogram.add(gradient());
    histogram.add(Image(200, 200, {11, 14, 19, 255}));
    const auto palette = histogram.palette(255);
    EXPECT_NE(std::find(palette.begin(), palette.end(), Rgb8{11, 14, 19}), palette.end());
}

TEST(PaletteMap, AgreesWithAMapThatRemembersNothing) {
    ColorHistogram histogram;
    histogram.add(gradient());
    const auto palette = histogram.palette(64);
    PaletteMap map(palette);
    for (std::uint32_t i = 0; i < 100000; ++i) {
        const std::uint32_t bits = i * 2654435761U;
        const Rgb8 color{static_cast<std::uint8_t>(bits >> 8),
                         static_cast<std::uint8_t>(bits >> 16),
                         static_cast<std::uint8_t>(bits >> 24)};
        const auto entry = map.nearest(color);
        if (i % 500 != 0) continue;
        EXPECT_EQ(entry, PaletteMap(palette).nearest(color));
        EXPECT_EQ(map.nearest(color), entry);
    }
}

}  // namespace
}  // namespace stormcellar::render
