// render/volume/ray_samples-inl.h -- what eight rays find at one slice.
//
// Part of render/volume/ray_packet.cpp, compiled once for each SIMD target.
// The eight codes round a point are loaded one ray after the other (gathers cost more on today's
// machines) and put together in general registers, two codes a load: writing them to memory and
// reading them back as a vector would wait for the store.
#if defined(STORMCELLAR_RAY_SAMPLES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef STORMCELLAR_RAY_SAMPLES_INL
#undef STORMCELLAR_RAY_SAMPLES_INL
#else
#define STORMCELLAR_RAY_SAMPLES_INL
#endif

#include <algorithm>
#include <cstring>

#include <hwy/highway.h>

#include "render/volume/code_vector-inl.h"
#include "render/volume/ray_packet.h"

HWY_BEFORE_NAMESPACE();
namespace stormcellar::render::HWY_NAMESPACE {

// A bin of the transfer function and the share of valued cells, for each ray.
struct Samples {
    HWY_ALIGN std::int32_t bin[packet_rays];
    HWY_ALIGN float valued[packet_rays];
    HWY_ALIGN float light[packet_rays];  // where the volume is lit
    bool any = false;                    // a share above 0
};

// The codes round the samples, by the sides in x (bit 0) and y (bit 1), at both levels.
struct Corners {
    CodeVec low[4], high[4];
};

// Where they are: numbers of codes, for each side in x and y at the lower level. What is not inside
// bricks, or whose upper neighbours do not follow, needs more than the first column.
struct Addresses {
    HWY_ALIGN std::int32_t column[4][packet_rays];
    HWY_ALIGN std::int32_t up[packet_rays];  // from the lower to the upper level
    bool inside_bricks = true;               // each of the eight is in the brick of the first
    bool paired = true;                      // the upper code follows the lower one
};

// How far beyond the cell below it a position lies.
struct Weights {
    FloatVec x, y, z;
};

constexpr std::int32_t next_x = grid::brick_edge * grid::brick_edge, next_y = grid::brick_edge;

// The place along one axis of the cell below a position; adds up the addresses. `across`: to the
// next cell, 0 at the grid's end. `next_follows`: to all of them it is `next`.
template <std::int32_t next>
HWY_INLINE FloatVec place_on_axis(FloatVec position, std::int32_t last, std::int32_t brick_stride,
                                  IntVec& at, IntVec& across, bool& next_follows) {
    const Floats f;
    const Ints i;
    const FloatVec held =
        hn::Min(hn::Max(position, hn::Zero(f)), hn::Set(f, static_cast<float>(last)));
    const IntVec cell = hn::ConvertTo(i, held);
    const IntVec edge = hn::Set(i, grid::brick_edge - 1);
    const IntVec in_brick = hn::And(cell, edge);
    at = hn::Add(at, hn::Add(hn::Mul(hn::ShiftRight<4>(cell), hn::Set(i, brick_stride)),
                             hn::Mul(in_brick, hn::Set(i, next))));
    const auto at_edge = hn::Eq(in_brick, edge);
    const auto at_end = hn::Eq(cell, hn::Set(i, last));
    across = hn::IfThenZeroElse(
        at_end, hn::IfThenElse(at_edge, hn::Set(i, brick_stride - next * (grid::brick_edge - 1)),
                               hn::Set(i, next)));
    next_follows = hn::AllFalse(i, hn::Or(at_edge, at_end));
    return hn::Sub(held, hn::ConvertTo(f, cell));
}

template <class Code>
HWY_INLINE std::uint64_t load(const std::byte* from) {
    Code code;
    std::memcpy(&code, from, sizeof(Code));
    return code;
}

// One code, or two in one number, from each ray's place. Unrolled by hand: the eight loads do not
// wait for each other.
template <class Code, int bytes>
HWY_INLINE CodeVec for_rays(const std::byte* codes, const std::int32_t* at) {
    const std::uint64_t first = load<Code>(codes + std::int64_t{at[0]} * bytes) |
                                load<Code>(codes + std::int64_t{at[1]} * bytes) << 16 |
                                load<Code>(codes + std::int64_t{at[2]} * bytes) << 32 |
                                load<Code>(codes + std::int64_t{at[3]} * bytes) << 48;
    const std::uint64_t last = load<Code>(codes + std::int64_t{at[4]} * bytes) |
                               load<Code>(codes + std::int64_t{at[5]} * bytes) << 16 |
                               load<Code>(codes + std::int64_t{at[6]} * bytes) << 32 |
                               load<Code>(codes + std::int64_t{at[7]} * bytes) << 48;
    return codes_of(first, last);
}

HWY_INLINE void load_pairs(const std::byte* codes, const std::int32_t* at, int c,
                           Corners& corners) {
    const CodeVec pairs = for_rays<std::uint16_t, 1>(codes, at);
    corners.low[c] = low_bytes(pairs);
    corners.high[c] = high_bytes(pairs);
}

template <class Code>
HWY_INLINE void load_singly(const std::byte* codes, const Addresses& where, Corners& corners) {
    const Ints i;
    for (int c = 0; c < 4; ++c) {
        HWY_ALIGN std::int32_t above[packet_rays];
        for (int ray = 0; ray < packet_rays; ray += lanes) {
            hn::Store(hn::Add(hn::Load(i, where.column[c] + ray), hn::Load(i, where.up + ray)), i,
                      above + ray);
        }
        corners.low[c] = for_rays<Code, sizeof(Code)>(codes, where.column[c]);
        corners.high[c] = for_rays<Code, sizeof(Code)>(codes, above);
    }
}

HWY_INLINE void load_corners(const PacketVolume& volume, const Addresses& where, Corners& corners) {
    if (volume.code_bytes == 2) return load_singly<std::uint16_t>(volume.codes, where, corners);
    if (!where.paired) return load_singly<std::uint8_t>(volume.codes, where, corners);
    if (where.inside_bricks) {
        load_pairs(volume.codes, where.column[0], 0, corners);
        load_pairs(volume.codes + next_x, where.column[0], 1, corners);
        load_pairs(volume.codes + next_y, where.column[0], 2, corners);
        load_pairs(volume.codes + next_x + next_y, where.column[0], 3, corners);
    } else {
        for (int c = 0; c < 4; ++c)
            load_pairs(volume.codes, where.column[c], c, corners);
    }
}

HWY_INLINE FloatVec mix(FloatVec from, FloatVec to, FloatVec share) {
    return hn::Add(from, hn::Mul(hn::Sub(to, from), share));
}

// All eight cells have values: their mean by weights.
HWY_INLINE FloatVec mean_of_all(const Corners& corners, const Weights& weights, int part) {
    FloatVec column[4];
    for (int c = 0; c < 4; ++c) {
        column[c] =
            mix(floats_of(corners.low[c], part), floats_of(corners.high[c], part), weights.z);
    }
    return mix(mix(column[0], column[1], weights.x), mix(column[2], column[3], weights.x),
               weights.y);
}

// The mean of those with values, and their share.
HWY_INLINE FloatVec mean_of_some(const Corners& corners, const Weights& weights, int part,
                                 FloatVec& valued) {
    const Floats f;
    const FloatVec one = hn::Set(f, 1.0F);
    const FloatVec x0 = hn::Sub(one, weights.x);
    const FloatVec y0 = hn::Sub(one, weights.y);
    const FloatVec z0 = hn::Sub(one, weights.z);
    const FloatVec column[4] = {hn::Mul(x0, y0), hn::Mul(weights.x, y0), hn::Mul(x0, weights.y),
                                hn::Mul(weights.x, weights.y)};
    FloatVec sum = hn::Zero(f);
    valued = hn::Zero(f);
    const auto add = [&](CodeVec codes, FloatVec weight) {
        const FloatVec code = floats_of(codes, part);
        const auto counts = hn::Ge(code, hn::Set(f, static_cast<float>(grid::first_value_code)));
        const FloatVec share = hn::IfThenElseZero(counts, weight);
        valued = hn::Add(valued, share);
        sum = hn::Add(sum, hn::Mul(share, code));
    };
    for (int c = 0; c < 4; ++c) {
        add(corners.low[c], hn::Mul(column[c], z0));
        add(corners.high[c], hn::Mul(column[c], weights.z));
    }
    return hn::Div(sum, hn::IfThenElse(hn::Gt(valued, hn::Zero(f)), valued, one));
}

HWY_INLINE void keep(const PacketVolume& volume, FloatVec code, FloatVec valued, int ray,
                     Samples& samples) {
    const Floats f;
    const Ints i;
    const FloatVec position = hn::Add(hn::Set(f, volume.transfer->bin_offset()),
                                      hn::Mul(hn::Set(f, volume.transfer->bin_slope()), code));
    const FloatVec bounded =
        hn::Min(hn::Max(position, hn::Zero(f)), hn::Set(f, TransferFunction::bin_count - 1.0F));
    hn::Store(hn::ConvertTo(i, bounded), i, samples.bin + ray);
    hn::Store(valued, f, samples.valued + ray);
}

HWY_INLINE void mix_corners(const PacketVolume& volume, const Corners& corners,
                            const Weights* weights, Samples& samples) {
    const Floats f;
    CodeVec least = corners.low[0];
    CodeVec largest = corners.low[0];
    for (int c = 0; c < 4; ++c) {
        least = least_of(least, least_of(corners.low[c], corners.high[c]));
        largest = largest_of(largest, largest_of(corners.low[c], corners.high[c]));
    }
    samples.any = !no_values(largest);
    if (!samples.any) {
        std::fill(samples.valued, samples.valued + packet_rays, 0.0F);
        std::fill(samples.bin, samples.bin + packet_rays, 0);
        return;
    }
    const bool all = all_values(least);
    for (int part = 0; part < parts; ++part) {
        FloatVec valued = hn::Set(f, 1.0F);
        const FloatVec code = all ? mean_of_all(corners, weights[part], part)
                                  : mean_of_some(corners, weights[part], part, valued);
        keep(volume, code, valued, part * lanes, samples);
    }
}

HWY_INLINE FloatVec level_of(const PacketVolume& volume, FloatVec z) {
    if (volume.levels == nullptr) return z;
    const Floats f;
    HWY_ALIGN float heights[lanes];
    hn::Store(z, f, heights);
    for (float& height : heights)
        height = (*volume.levels)(height);
    return hn::Load(f, heights);
}

HWY_INLINE FloatVec drop(const CurvedLevels& curve, FloatVec x, FloatVec y) {
    const Floats f;
    const FloatVec dx = hn::Sub(x, hn::Set(f, curve.middle_x));
    const FloatVec dy = hn::Sub(y, hn::Set(f, curve.middle_y));
    return hn::Add(hn::Mul(hn::Set(f, curve.curve_x), hn::Mul(dx, dx)),
                   hn::Mul(hn::Set(f, curve.curve_y), hn::Mul(dy, dy)));
}

}  // namespace stormcellar::render::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
