#include "render/animation/frame_change.h"

#include <gtest/gtest.h>

#include "stormcellar/render/image.h"

namespace stormcellar::render {
namespace {

Rectangle change(const Image& before, const Image& after) {
    return changed_rectangle(before.rgba, after.rgba, before.width, before.height, 4);
}

TEST(ChangedRectangle, IsOnePixelWhenNothingChanged) {
    const Image image(7, 5, {1, 2, 3, 255});
    EXPECT_EQ(change(image, image), (Rectangle{0, 0, 1, 1}));
}

TEST(ChangedRectangle, HoldsEveryPixelThatDiffersAndNoMore) {
    const Image before(7, 5, {1, 2, 3, 255});
    for (int y0 = 0; y0 < 5; ++y0) {
        for (int x0 = 0; x0 < 7; ++x0) {
            for (int y1 = y0; y1 < 5; ++y1) {
                for (int x1 = x0; x1 < 7; ++x1) {
                    Image after = before;
                    after.set(x0, y1, {1, 2, 4, 255});  // one corner changes only in blue
                    after.set(x1, y0, {0, 2, 3, 255});  // the other only in red
                    EXPECT_EQ(change(before, after), (Rectangle{x0, y0, x1 - x0 + 1, y1 - y0 + 1}));
                }
            }
        }
    }
}

}  // namespace
}  // namespace stormcellar::render
