#include "render/image/layer.h"

#include <algorithm>

#include "base/parallel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/image/layer.cpp"
#include <hwy/foreach_target.h>
// This include must come after foreach_target.h, which compiles this file once for each target.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace stormcellar::render::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Composites the four channels of one pixel. The alpha of the result is 255.
HWY_INLINE void composite_pixel(const float* from, std::uint8_t* to) {
    for (int c = 0; c < 4; ++c) {
        const float level = from[c] * 255.0F + (1 - from[3]) * static_cast<float>(to[c]);
        const float rounded = level + 0.5F;
        to[c] = static_cast<std::uint8_t>(rounded < 0 ? 0 : rounded > 255 ? 255 : rounded);
    }
}

void composite_row(const float* from, std::uint8_t* to, int pixels) {
    int pixel = 0;
#if HWY_TARGET != HWY_SCALAR
    const hn::CappedTag<float, 16> f;
    const hn::RebindToSigned<decltype(f)> i;
    const hn::Rebind<std::uint8_t, decltype(f)> u;
    const int step = static_cast<int>(hn::Lanes(f)) / 4;
    for (; pixel + step <= pixels; pixel += step) {
        const auto front = hn::LoadU(f, from + pixel * 4);
        const auto through = hn::Sub(hn::Set(f, 1.0F), hn::Broadcast<3>(front));
        const auto back = hn::ConvertTo(f, hn::PromoteTo(i, hn::LoadU(u, to + pixel * 4)));
        const auto level = hn::Add(hn::Mul(front, hn::Set(f, 255.0F)), hn::Mul(through, back));
        const auto bounded =
            hn::Min(hn::Max(hn::Add(level, hn::Set(f, 0.5F)), hn::Zero(f)), hn::Set(f, 255.0F));
        hn::StoreU(hn::DemoteTo(u, hn::ConvertTo(i, bounded)), u, to + pixel * 4);
    }
#endif
    for (; pixel < pixels; ++pixel)
        composite_pixel(from + pixel * 4, to + pixel * 4);
}

}  // namespace stormcellar::render::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace stormcellar::render {

HWY_EXPORT(composite_row);

void composite_over(const Layer& layer, Image& background, int left, int top, int threads) {
    constexpr int rows = 16;
    const auto width = static_cast<std::size_t>(layer.width);
    const auto row_of = HWY_DYNAMIC_DISPATCH(composite_row);
    for_each_piece((layer.height + rows - 1) / rows, threads, [&](int piece) {
        for (int y = piece * rows; y < std::min((piece + 1) * rows, layer.height); ++y) {
            const auto to =
                (static_cast<std::size_t>(y + top) * static_cast<std::size_t>(background.width) +
                 static_cast<std::size_t>(left)) *
                4;
            row_of(layer.rgba.data() + static_cast<std::size_t>(y) * width * 4,
                   background.rgba.data() + to, layer.width);
        }
    });
}

}  // namespace stormcellar::render
#endif
