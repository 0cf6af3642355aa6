// render/volume/ray_samples-inl.h -- finds the values at one slice for the rays of all lanes.
//
// This file is a part of render/volume/ray_packet.cpp, which is compiled once for each SIMD target.
// The eight codes around a point are loaded for one ray after the other and combined in general
// registers, because gathers are slower on today's machines.
#if defined(STORMCELLAR_RAY_SAMPLES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef STORMCELLAR_RAY_SAMPLES_INL
#undef STORMCELLAR_RAY_SAMPLES_INL
#else
#define STORMCELLAR_RAY_SAMPLES_INL
#endif

#include <hwy/highway.h>

#include "render/volume/lanes-inl.h"
#include "render/volume/ray_packet.h"

HWY_BEFORE_NAMESPACE();
namespace stormcellar::render::HWY_NAMESPACE {

// For each ray, a bin of the transfer function and the share of cells that have values.
struct Samples {
    // An implicit constructor would be compiled for the default target, not for this target.
    HWY_INLINE Samples() {}
    IntVec bin;
    FloatVec valued;
};

// A place along one axis: the cell below it, and its distance from that cell, in cells.
struct Place {
    IntVec cell;
    FloatVec beyond;
};

HWY_INLINE Place place_of(FloatVec position, std::int32_t last) {
    const Floats f;
    const FloatVec held =
        hn::Min(hn::Max(position, hn::Zero(f)), hn::Set(f, static_cast<float>(last)));
    const IntVec cell = hn::ConvertTo(Ints(), held);
    return {cell, hn::Sub(held, hn::ConvertTo(f, cell))};
}

// The place of one sample of each ray.
struct Places {
    Place x, y, z;
};

// The eight codes around a place. The number of a code has one bit for its side along each axis: x
// (bit 0), y (bit 1) and z (bit 2).
struct Corners {
    HWY_INLINE Corners() {}  // as for Samples
    IntVec code[8];
};

// Splits two words of a table of corners into the lower four codes and the upper four.
HWY_INLINE Corners corners_of(const Halves& levels) {
    const IntVec byte = hn::Set(Ints(), 0xFF);
    const auto unpack = [&](IntVec word, IntVec* codes) {
        codes[0] = hn::And(word, byte);
        codes[1] = hn::And(hn::ShiftRight<8>(word), byte);
        codes[2] = hn::And(hn::ShiftRight<16>(word), byte);
        codes[3] = hn::And(hn::ShiftRight<24>(word), byte);
    };
    Corners corners;
    unpack(levels.low, corners.code);
    unpack(levels.high, corners.code + 4);
    return corners;
}

// Takes the codes from a CornerTable: one load of 64 bits brings all eight
// (render/volume/corner_table.h).
struct FromTable {
    static HWY_INLINE Corners corners(const PacketVolume& volume, const Places& at) {
        const Ints i;
        const LaneNumbers words(
            hn::Add(hn::Add(hn::Mul(at.x.cell, hn::Set(i, volume.word_stride_x)),
                            hn::Mul(at.y.cell, hn::Set(i, volume.word_stride_y))),
                    at.z.cell));
        const Halves levels = halves_of(
            [&](int lane) { return load_as<std::uint64_t>(volume.words + words[lane] * 4); });
        return corners_of(levels);
    }
};

// Takes the codes from the bricks themselves.
struct FromBricks {
    // The offsets of the four lower codes, by their sides along x and y.
    using Columns = LaneNumbers[4];

    // Adds the offset of the cell along one axis to `at`. Returns the distance to the next cell:
    // usually `next`, more across the border of a brick, and 0 at the end of the grid.
    template <std::int32_t next>
    static HWY_INLINE IntVec step_along(IntVec cell, std::int32_t last, std::int32_t brick_stride,
                                        IntVec& at) {
        const Ints i;
        const IntVec edge = hn::Set(i, grid::brick_edge - 1);
        const IntVec in_brick = hn::And(cell, edge);
        at = hn::Add(at, hn::Add(hn::Mul(hn::ShiftRight<4>(cell), hn::Set(i, brick_stride)),
                                 hn::Mul(in_brick, hn::Set(i, next))));
        const IntVec across = hn::IfThenElse(
            hn::Eq(in_brick, edge), hn::Set(i, brick_stride - next * (grid::brick_edge - 1)),
            hn::Set(i, next));
        return hn::IfThenZeroElse(hn::Eq(cell, hn::Set(i, last)), across);
    }

    static HWY_INLINE Corners corners(const PacketVolume& volume, const Places& at) {
        constexpr std::int32_t next_y = grid::brick_edge, next_x = next_y * grid::brick_edge;
        const Ints i;
        IntVec here = hn::Zero(i);
        const IntVec east =
            step_along<next_x>(at.x.cell, volume.last_x, volume.brick_stride_x, here);
        const IntVec north =
            step_along<next_y>(at.y.cell, volume.last_y, volume.brick_stride_y, here);
        const IntVec up = step_along<1>(at.z.cell, volume.last_z,
                                        static_cast<std::int32_t>(grid::brick_cells), here);
        const Columns columns{LaneNumbers(here), LaneNumbers(hn::Add(here, east)),
                              LaneNumbers(hn::Add(here, north)),
                              LaneNumbers(hn::Add(hn::Add(here, east), north))};
        if (volume.code_bytes == 1 && hn::AllTrue(i, hn::Eq(up, hn::Set(i, 1)))) {
            return paired(volume.codes, columns);
        }
        const LaneNumbers rise(up);
        return volume.code_bytes == 1 ? singly<std::uint8_t>(volume.codes, columns, rise)
                                      : singly<std::uint16_t>(volume.codes, columns, rise);
    }

    // Loads the codes of both levels of a column as one number. The two are side by side, except in
    // the uppermost level of a brick.
    static HWY_INLINE Corners paired(const std::byte* codes, const Columns& columns) {
        const Ints i;
        const Halves words = halves_of([&](int lane) {
            const auto pair = [&](int c) {
                return std::uint64_t{load_as<std::uint16_t>(codes + columns[c][lane])};
            };
            return pair(0) | pair(1) << 16 | pair(2) << 32 | pair(3) << 48;
        });
        const IntVec byte = hn::Set(i, 0xFF);
        Corners corners;
        const auto unpack = [&](IntVec word, int c) {
            corners.code[c] = hn::And(word, byte);
            corners.code[c + 4] = hn::And(hn::ShiftRight<8>(word), byte);
            corners.code[c + 1] = hn::And(hn::ShiftRight<16>(word), byte);
            corners.code[c + 5] = hn::And(hn::ShiftRight<24>(word), byte);
        };
        unpack(words.low, 0);
        unpack(words.high, 2);
        return corners;
    }

    // Loads one code after the other. This is for codes of two bytes, and across the border between
    // two bricks.
    template <class Code>
    static HWY_INLINE Corners singly(const std::byte* codes, const Columns& columns,
                                     const LaneNumbers& rise) {
        const Ints i;
        const IntVec low = hn::Set(i, 0xFFFF);
        Corners corners;
        for (int level = 0; level < 2; ++level) {
            const Halves words = halves_of([&](int lane) {
                const auto code = [&](int c) {
                    const std::int64_t at = columns[c][lane] + level * rise[lane];
                    return std::uint64_t{
                        load_as<Code>(codes + at * static_cast<std::int64_t>(sizeof(Code)))};
                };
                return code(0) | code(1) << 16 | code(2) << 32 | code(3) << 48;
            });
            IntVec* level_codes = corners.code + 4 * level;
            level_codes[0] = hn::And(words.low, low);
            level_codes[1] = hn::And(hn::ShiftRight<16>(words.low), low);
            level_codes[2] = hn::And(words.high, low);
            level_codes[3] = hn::And(hn::ShiftRight<16>(words.high), low);
        }
        return corners;
    }
};

HWY_INLINE FloatVec mix(FloatVec from, FloatVec to, FloatVec share) {
    return hn::Add(from, hn::Mul(hn::Sub(to, from), share));
}

// Returns the weighted mean of eight cells that all have values, by seven linear interpolations.
HWY_INLINE FloatVec mean_of_all(const Corners& corners, const Places& at) {
    const Floats f;
    FloatVec column[4];
    for (int c = 0; c < 4; ++c) {
        column[c] = mix(hn::ConvertTo(f, corners.code[c]), hn::ConvertTo(f, corners.code[c + 4]),
                        at.z.beyond);
    }
    return mix(mix(column[0], column[1], at.x.beyond), mix(column[2], column[3], at.x.beyond),
               at.y.beyond);
}

// Returns the weighted mean of the cells that have values. Sets `valued` to the sum of their
// weights.
HWY_INLINE FloatVec mean_of_some(const PacketVolume& volume, const Corners& corners,
                                 const Places& at, FloatVec& valued) {
    const Floats f;
    const FloatVec one = hn::Set(f, 1.0F);
    const FloatVec x0 = hn::Sub(one, at.x.beyond);
    const FloatVec y0 = hn::Sub(one, at.y.beyond);
    const FloatVec z0 = hn::Sub(one, at.z.beyond);
    const FloatVec column[4] = {hn::Mul(x0, y0), hn::Mul(at.x.beyond, y0), hn::Mul(x0, at.y.beyond),
                                hn::Mul(at.x.beyond, at.y.beyond)};
    const IntVec last_state = hn::Set(Ints(), volume.last_state);
    FloatVec sum = hn::Zero(f);
    valued = hn::Zero(f);
    const auto add = [&](IntVec code, FloatVec weight) {
        const auto counts = hn::RebindMask(f, hn::Gt(code, last_state));
        const FloatVec share = hn::IfThenElseZero(counts, weight);
        valued = hn::Add(valued, share);
        sum = hn::Add(sum, hn::Mul(share, hn::ConvertTo(f, code)));
    };
    for (int c = 0; c < 4; ++c) {
        add(corners.code[c], hn::Mul(column[c], z0));
        add(corners.code[c + 4], hn::Mul(column[c], at.z.beyond));
    }
    return hn::Div(sum, hn::IfThenElse(hn::Gt(valued, hn::Zero(f)), valued, one));
}

// Returns the bin of the transfer function for a code, which may have a fraction.
HWY_INLINE IntVec bin_of(const PacketVolume& volume, FloatVec code) {
    const Floats f;
    const FloatVec position = hn::Add(hn::Set(f, volume.transfer->bin_offset()),
                                      hn::Mul(hn::Set(f, volume.transfer->bin_slope()), code));
    const FloatVec bounded =
        hn::Min(hn::Max(position, hn::Zero(f)), hn::Set(f, TransferFunction::bin_count - 1.0F));
    return hn::ConvertTo(Ints(), bounded);
}

// Mixes the eight codes around each ray. Returns false if no ray finds a value; then all shares are
// 0. Inside echo, usually all eight cells of a ray have values, and the faster mean_of_all() gives
// its value. mean_of_some() is computed only if some ray needs it.
HWY_INLINE bool mix_corners(const PacketVolume& volume, const Corners& corners, const Places& at,
                            Samples& samples) {
    const Floats f;
    const Ints i;
    IntVec least = corners.code[0];
    IntVec largest = corners.code[0];
    for (int c = 1; c < 8; ++c) {
        least = hn::Min(least, corners.code[c]);
        largest = hn::Max(largest, corners.code[c]);
    }
    const IntVec last_state = hn::Set(i, volume.last_state);
    samples.bin = hn::Zero(i);
    samples.valued = hn::Zero(f);
    if (hn::AllFalse(i, hn::Gt(largest, last_state))) return false;
    const auto all = hn::RebindMask(f, hn::Gt(least, last_state));
    FloatVec code = mean_of_all(corners, at);
    samples.valued = hn::Set(f, 1.0F);
    if (!hn::AllTrue(f, all)) {
        FloatVec valued;
        const FloatVec some = mean_of_some(volume, corners, at, valued);
        code = hn::IfThenElse(all, code, some);
        samples.valued = hn::IfThenElse(all, samples.valued, valued);
    }
    samples.bin = bin_of(volume, code);
    return true;
}

// Converts heights of drawn space into levels, one ray after the other, if the levels are not
// evenly spaced.
HWY_INLINE FloatVec level_of(const PacketVolume& volume, FloatVec z) {
    if (volume.levels == nullptr) return z;
    const Floats f;
    HWY_ALIGN float heights[lanes];
    hn::Store(z, f, heights);
    for (float& height : heights)
        height = (*volume.levels)(height);
    return hn::Load(f, heights);
}

// Returns how much the drawn curve of the earth lowers a place (see RayPacket).
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
