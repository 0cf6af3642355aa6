#include "render/volume/step_integrals.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/volume/step_integrals.cpp"
#include <hwy/foreach_target.h>
// This include must come after foreach_target.h, which compiles this file once for each target.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace stormcellar::render::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Uses each lane for a step of its own, whose sums stay in registers from its first bin to its
// last.
void integrate(const BinLooks& looks, const PieceOpacities& opacities, std::size_t distance,
               StepDirection direction, StepIntegrals& result) {
    const hn::CappedTag<double, bins_of_a_vector> d;
    const std::size_t lanes = hn::Lanes(d);
    const auto half = hn::Set(d, 0.5);
    const auto zero = hn::Zero(d);
    for (std::size_t i = 0; i < step_bins - distance; i += lanes) {
        auto red = zero;
        auto green = zero;
        auto blue = zero;
        auto depth = zero;
        auto through = hn::Set(d, 1.0);
        for (std::size_t m = 0; m <= distance; ++m) {
            const std::size_t at = i + (direction == StepDirection::rising ? m : distance - m);
            const bool is_end = m == 0 || m == distance;
            const OfBins& opacity = is_end ? opacities.half : opacities.whole;
            const auto seen = hn::Mul(through, hn::LoadU(d, opacity.data() + at));
            red = hn::Add(red, hn::Mul(seen, hn::LoadU(d, looks.color[0].data() + at)));
            green = hn::Add(green, hn::Mul(seen, hn::LoadU(d, looks.color[1].data() + at)));
            blue = hn::Add(blue, hn::Mul(seen, hn::LoadU(d, looks.color[2].data() + at)));
            through = hn::Sub(through, seen);
            const auto of_bin = hn::LoadU(d, looks.depth.data() + at);
            depth = hn::Add(depth, is_end ? hn::Mul(half, of_bin) : of_bin);
        }
        hn::StoreU(red, d, result.color[0].data() + i);
        hn::StoreU(green, d, result.color[1].data() + i);
        hn::StoreU(blue, d, result.color[2].data() + i);
        hn::StoreU(through, d, result.through.data() + i);
        hn::StoreU(depth, d, result.depth.data() + i);
    }
}

}  // namespace stormcellar::render::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace stormcellar::render {

HWY_EXPORT(integrate);

void integrate_steps(const BinLooks& looks, const PieceOpacities& opacities, std::size_t distance,
                     StepDirection direction, StepIntegrals& result) {
    HWY_DYNAMIC_DISPATCH(integrate)(looks, opacities, distance, direction, result);
}

}  // namespace stormcellar::render
#endif
