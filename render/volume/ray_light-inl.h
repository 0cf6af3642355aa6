// render/volume/ray_light-inl.h -- finds the factor of the light at a place of the volume
// (render/volume/shade_field.h).
//
// This file is a part of render/volume/ray_packet.cpp, which is compiled once for each SIMD target.
// For each ray, one load of 64 bits reads the eight codes around its place.
#if defined(STORMCELLAR_RAY_LIGHT_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef STORMCELLAR_RAY_LIGHT_INL
#undef STORMCELLAR_RAY_LIGHT_INL
#else
#define STORMCELLAR_RAY_LIGHT_INL
#endif

#include <hwy/highway.h>

#include "render/volume/ray_samples-inl.h"

HWY_BEFORE_NAMESPACE();
namespace stormcellar::render::HWY_NAMESPACE {

// Returns the factors of the light at positions in cells and levels.
HWY_INLINE FloatVec light_at(const PacketLight& light, FloatVec x, FloatVec y, FloatVec level) {
    const Floats f;
    const Ints i;
    constexpr float scale = 1.0F / ShadeField::cells_across;
    const auto coarse = [&](FloatVec cells) {
        return hn::Sub(hn::Mul(hn::Add(cells, hn::Set(f, 0.5F)), hn::Set(f, scale)),
                       hn::Set(f, 0.5F));
    };
    const Places at{place_of(coarse(x), light.last_x), place_of(coarse(y), light.last_y),
                    place_of(level, light.last_z)};
    const LaneNumbers words(hn::Add(hn::Add(hn::Mul(at.x.cell, hn::Set(i, light.stride_x)),
                                            hn::Mul(at.y.cell, hn::Set(i, light.stride_y))),
                                    at.z.cell));
    const Halves levels =
        halves_of([&](int lane) { return load_as<std::uint64_t>(light.words + words[lane] * 4); });
    return hn::Mul(mean_of_all(corners_of(levels), at), hn::Set(f, ShadeField::of_code));
}

}  // namespace stormcellar::render::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
