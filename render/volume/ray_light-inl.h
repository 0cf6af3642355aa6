// render/volume/ray_light-inl.h -- how light samples are.
//
// This is a part of render/volume/ray_packet.cpp, which is compiled once for each SIMD target.
#if defined(STORMCELLAR_RAY_LIGHT_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef STORMCELLAR_RAY_LIGHT_INL
#undef STORMCELLAR_RAY_LIGHT_INL
#else
#define STORMCELLAR_RAY_LIGHT_INL
#endif

#include <algorithm>

#include <hwy/highway.h>

#include "render/volume/ray_samples-inl.h"

HWY_BEFORE_NAMESPACE();
namespace stormcellar::render::HWY_NAMESPACE {

constexpr float darkest = 0.35F;  // factor for a steep surface that is turned away from the sun

// Returns the codes of cells with values, and 0 for others.
HWY_INLINE FloatVec density_of(IntVec code) {
    const IntVec last_state = hn::Set(Ints(), grid::first_value_code - 1);
    return hn::ConvertTo(Floats(), hn::IfThenElseZero(hn::Gt(code, last_state), code));
}

// Returns a factor that is 1 where the surface faces the sun, down to `darkest` where it is steep
// and turned away. The surface is that of equal values: its normal is the gradient of the trilinear
// mix of the eight cells.
HWY_INLINE FloatVec gradient_light(const PacketLight& light, const Corners& corners,
                                   const Places& at) {
    const Floats f;
    FloatVec low[4], high[4], column[4];
    for (int c = 0; c < 4; ++c) {
        low[c] = density_of(corners.code[c]);
        high[c] = density_of(corners.code[c + 4]);
        column[c] = mix(low[c], high[c], at.z.beyond);
    }
    // The derivative of the mix along each axis is the difference across that axis, interpolated
    // along the two others.
    const auto rise = [&](int c) { return hn::Sub(high[c], low[c]); };
    const FloatVec east =
        mix(hn::Sub(column[1], column[0]), hn::Sub(column[3], column[2]), at.y.beyond);
    const FloatVec north =
        mix(hn::Sub(column[2], column[0]), hn::Sub(column[3], column[1]), at.x.beyond);
    const FloatVec up =
        mix(mix(rise(0), rise(1), at.x.beyond), mix(rise(2), rise(3), at.x.beyond), at.y.beyond);
    const FloatVec gradient[3] = {hn::Mul(east, hn::Set(f, light.per_cell[0])),
                                  hn::Mul(north, hn::Set(f, light.per_cell[1])),
                                  hn::Mul(up, hn::Set(f, light.per_cell[2]))};
    FloatVec square = hn::Zero(f);
    FloatVec towards = hn::Zero(f);  // the normal points to lower values
    for (int axis = 0; axis < 3; ++axis) {
        square = hn::Add(square, hn::Mul(gradient[axis], gradient[axis]));
        towards = hn::Sub(towards, hn::Mul(gradient[axis], hn::Set(f, light.sun[axis])));
    }
    // A flat gradient has no direction to speak of, so the effect grows with steepness: half_steep
    // gives half of it. `turned` is 0 toward the sun and 1 away from it.
    const FloatVec steep = hn::Sqrt(square);
    const FloatVec some = hn::Max(steep, hn::Set(f, 1e-20F));
    const FloatVec share = hn::Div(steep, hn::Add(steep, hn::Set(f, light.half_steep)));
    const FloatVec turned =
        hn::Mul(hn::Set(f, 0.5F), hn::Sub(hn::Set(f, 1.0F), hn::Div(towards, some)));
    const FloatVec dark = hn::Mul(hn::Set(f, 1 - darkest), hn::Mul(share, turned));
    return hn::Sub(hn::Set(f, 1.0F), dark);
}

// Returns the light of samples at positions in cells and levels: the shadow from the light volume,
// times the factor of the gradient.
HWY_INLINE FloatVec light_of(const PacketLight& light, const Corners& corners, const Places& at,
                             FloatVec valued) {
    const Floats f;
    FloatVec factor = hn::Set(f, 1.0F);
    if (light.volume != nullptr) {
        HWY_ALIGN float x[lanes], y[lanes], z[lanes], share[lanes], factors[lanes];
        const auto store = [&](const Place& place, float* to) {
            hn::Store(hn::Add(hn::ConvertTo(f, place.cell), place.beyond), f, to);
        };
        store(at.x, x);
        store(at.y, y);
        store(at.z, z);
        hn::Store(valued, f, share);
        for (int lane = 0; lane < lanes; ++lane) {
            factors[lane] = share[lane] > 0 ? light.volume->at(x[lane], y[lane], z[lane]) : 1.0F;
        }
        factor = hn::Load(f, factors);
    }
    return light.gradient ? hn::Mul(factor, gradient_light(light, corners, at)) : factor;
}

}  // namespace stormcellar::render::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
