// render/volume/ray_light-inl.h -- how light eight samples are.
//
// Part of render/volume/ray_packet.cpp, compiled once for each SIMD target.
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

constexpr float darkest = 0.35F;  // of a steep surface turned away from the sun

// Codes of cells with values, 0 of others.
HWY_INLINE FloatVec density_of(CodeVec codes, int part) {
    const Floats f;
    const FloatVec code = floats_of(codes, part);
    return hn::IfThenElseZero(hn::Ge(code, hn::Set(f, static_cast<float>(grid::first_value_code))),
                              code);
}

// 1 where the surface looks to the sun, down to `darkest` where it is steep and turned away; by the
// gradient of the trilinear mix of the eight cells.
HWY_INLINE FloatVec gradient_light(const PacketLight& light, const Corners& corners,
                                   const Weights& weights, int part) {
    const Floats f;
    FloatVec low[4], high[4], column[4];
    for (int c = 0; c < 4; ++c) {
        low[c] = density_of(corners.low[c], part);
        high[c] = density_of(corners.high[c], part);
        column[c] = mix(low[c], high[c], weights.z);
    }
    const auto rise = [&](int c) { return hn::Sub(high[c], low[c]); };
    const FloatVec east =
        mix(hn::Sub(column[1], column[0]), hn::Sub(column[3], column[2]), weights.y);
    const FloatVec north =
        mix(hn::Sub(column[2], column[0]), hn::Sub(column[3], column[1]), weights.x);
    const FloatVec up =
        mix(mix(rise(0), rise(1), weights.x), mix(rise(2), rise(3), weights.x), weights.y);
    const FloatVec gradient[3] = {hn::Mul(east, hn::Set(f, light.per_cell[0])),
                                  hn::Mul(north, hn::Set(f, light.per_cell[1])),
                                  hn::Mul(up, hn::Set(f, light.per_cell[2]))};
    FloatVec square = hn::Zero(f);
    FloatVec towards = hn::Zero(f);  // the normal points to where there is less
    for (int axis = 0; axis < 3; ++axis) {
        square = hn::Add(square, hn::Mul(gradient[axis], gradient[axis]));
        towards = hn::Sub(towards, hn::Mul(gradient[axis], hn::Set(f, light.sun[axis])));
    }
    const FloatVec steep = hn::Sqrt(square);
    const FloatVec some = hn::Max(steep, hn::Set(f, 1e-20F));
    const FloatVec share = hn::Div(steep, hn::Add(steep, hn::Set(f, light.half_steep)));
    const FloatVec turned =
        hn::Mul(hn::Set(f, 0.5F), hn::Sub(hn::Set(f, 1.0F), hn::Div(towards, some)));
    const FloatVec dark = hn::Mul(hn::Set(f, 1 - darkest), hn::Mul(share, turned));
    return hn::Sub(hn::Set(f, 1.0F), dark);
}

// Places in cells and levels, of each ray.
struct Places {
    HWY_ALIGN float x[packet_rays], y[packet_rays], z[packet_rays];
};

HWY_INLINE void light_samples(const PacketLight& light, const Corners& corners,
                              const Weights* weights, const Places& places, Samples& samples) {
    const Floats f;
    for (int ray = 0; ray < packet_rays; ++ray) {
        const bool shows = light.volume != nullptr && samples.valued[ray] > 0;
        samples.light[ray] =
            shows ? light.volume->at(places.x[ray], places.y[ray], places.z[ray]) : 1.0F;
    }
    if (!light.gradient) return;
    for (int part = 0; part < parts; ++part) {
        float* lit = samples.light + part * lanes;
        hn::Store(hn::Mul(hn::Load(f, lit), gradient_light(light, corners, weights[part], part)), f,
                  lit);
    }
}

// At slice t, or where the ray enters or leaves the box when that is nearer to its middle.
template <bool curved, bool lit>
HWY_INLINE void take_samples(const PacketVolume& volume, const RayPacket& rays, float t,
                             Samples& samples) {
    const Floats f;
    const Ints i;
    Addresses where;
    Weights weights[parts];
    Places places;
    for (int part = 0; part < parts; ++part) {
        const int ray = part * lanes;
        const FloatVec held = hn::Min(hn::Max(hn::Set(f, t), hn::LoadU(f, rays.enter + ray)),
                                      hn::LoadU(f, rays.leave + ray));
        const auto position = [&](const float* start, const float* step) {
            return hn::Add(hn::LoadU(f, start + ray), hn::Mul(held, hn::LoadU(f, step + ray)));
        };
        const FloatVec x = position(rays.x, rays.step_x);
        const FloatVec y = position(rays.y, rays.step_y);
        FloatVec z = position(rays.z, rays.step_z);
        if constexpr (curved) z = hn::Add(z, drop(*volume.curve, x, y));
        IntVec at = hn::Zero(i);
        IntVec east, north, up;
        bool follows_x = false, follows_y = false, follows_z = false;
        weights[part].x =
            place_on_axis<next_x>(x, volume.last_x, volume.brick_stride_x, at, east, follows_x);
        weights[part].y =
            place_on_axis<next_y>(y, volume.last_y, volume.brick_stride_y, at, north, follows_y);
        const FloatVec level = level_of(volume, z);
        if constexpr (lit) {
            hn::Store(x, f, places.x + ray);
            hn::Store(y, f, places.y + ray);
            hn::Store(level, f, places.z + ray);
        }
        weights[part].z = place_on_axis<1>(
            level, volume.last_z, static_cast<std::int32_t>(grid::brick_cells), at, up, follows_z);
        where.inside_bricks = where.inside_bricks && follows_x && follows_y;
        where.paired = where.paired && follows_z;
        hn::Store(at, i, where.column[0] + ray);
        hn::Store(hn::Add(at, east), i, where.column[1] + ray);
        hn::Store(hn::Add(at, north), i, where.column[2] + ray);
        hn::Store(hn::Add(hn::Add(at, east), north), i, where.column[3] + ray);
        hn::Store(up, i, where.up + ray);
    }
    Corners corners;
    load_corners(volume, where, corners);
    mix_corners(volume, corners, weights, samples);
    if constexpr (lit) {
        if (samples.any) {
            light_samples(*volume.light, corners, weights, places, samples);
        } else {
            std::fill(samples.light, samples.light + packet_rays, 1.0F);
        }
    }
}

}  // namespace stormcellar::render::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
