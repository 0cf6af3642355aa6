#include "render/volume/ray_packet.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/volume/ray_packet.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, which compiles this file once for each target.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace stormcellar::render::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, packet_rays>;
using Ints = hn::RebindToSigned<Floats>;
using FloatVec = hn::Vec<Floats>;
using IntVec = hn::Vec<Ints>;

constexpr float opaque_enough = 0.001F;  // a ray ends when less light than this comes through

// 1 - exp(-depth) for depths of 0 and more, to 2e-7. Not the library's, whose fused operations give
// other bits on other targets.
HWY_INLINE FloatVec opacity_of(FloatVec depth) {
    const Floats f;
    const Ints i;
    constexpr float log2_e = 1.44269504F;
    // exp(-depth) = 2^-whole * 2^-part, part within -1/2 to 1/2.
    const FloatVec exponent = hn::Min(hn::Mul(depth, hn::Set(f, log2_e)), hn::Set(f, 120.0F));
    const IntVec whole = hn::ConvertTo(i, hn::Add(exponent, hn::Set(f, 0.5F)));
    const FloatVec part = hn::Sub(hn::ConvertTo(f, whole), exponent);
    constexpr float series[] = {1.5403530e-4F, 1.3333558e-3F, 9.6181291e-3F, 5.5504109e-2F,
                                2.4022651e-1F, 6.9314718e-1F, 1.0F};  // ln(2)^n / n!
    FloatVec power = hn::Set(f, series[0]);
    for (std::size_t n = 1; n < std::size(series); ++n)
        power = hn::Add(hn::Mul(power, part), hn::Set(f, series[n]));
    const IntVec scale = hn::ShiftLeft<23>(hn::Sub(hn::Set(i, 127), whole));
    return hn::Sub(hn::Set(f, 1.0F), hn::Mul(power, hn::BitCast(f, scale)));
}

// What the rays find at a slice: a bin of the transfer function and the share of valued cells.
struct Samples {
    HWY_ALIGN std::int32_t bin[packet_rays];
    HWY_ALIGN float valued[packet_rays];
};

// The codes round each sample: bits 0-1 of the first number are the sides in x and y. With 8-bit
// codes a pair holds the lower and the upper level's code, low byte first.
struct Corners {
    HWY_ALIGN std::int32_t low[4][packet_rays];   // at the lower level
    HWY_ALIGN std::int32_t high[4][packet_rays];  // at the upper one
};

struct Addresses {
    HWY_ALIGN std::int32_t run[4][packet_rays];  // of the columns, in the lowest brick
    HWY_ALIGN std::int32_t lower[packet_rays];   // cells along z
    HWY_ALIGN std::int32_t upper[packet_rays];
    bool paired = true;  // every upper cell follows its lower one in the same run
};

// Cell below a position and how far beyond it, for the rays from `lane` on.
struct Between {
    IntVec cell;
    IntVec next;
    FloatVec weight;
};

HWY_INLINE Between between(FloatVec position, std::int32_t last) {
    const Floats f;
    const Ints i;
    const FloatVec inside =
        hn::Min(hn::Max(position, hn::Zero(f)), hn::Set(f, static_cast<float>(last)));
    const IntVec cell = hn::ConvertTo(i, inside);
    return {cell, hn::Min(hn::Add(cell, hn::Set(i, 1)), hn::Set(i, last)),
            hn::Sub(inside, hn::ConvertTo(f, cell))};
}

// Runs up to a cell along x (spread 16) or y (spread 1).
template <int spread_bits>
HWY_INLINE IntVec runs_to(IntVec cell, std::int32_t brick_stride) {
    const Ints i;
    const IntVec in_brick = hn::And(cell, hn::Set(i, grid::brick_edge - 1));
    return hn::Add(hn::Mul(hn::ShiftRight<4>(cell), hn::Set(i, brick_stride)),
                   hn::ShiftLeft<spread_bits>(in_brick));
}

// A run of the lowest brick and a cell along z -> a cell's place among the codes.
HWY_INLINE std::size_t place(std::int32_t run, std::int32_t z) {
    constexpr std::size_t runs_in_brick = grid::brick_edge * grid::brick_edge;
    const auto level = static_cast<std::size_t>(z);
    return (static_cast<std::size_t>(run) + level / grid::brick_edge * runs_in_brick) *
               grid::brick_edge +
           level % grid::brick_edge;
}

template <class Code>
HWY_INLINE std::int32_t code_at(const std::byte* codes, std::size_t at) {
    Code code;
    std::memcpy(&code, codes + at * sizeof(Code), sizeof(Code));
    return code;
}

template <class Code>
HWY_INLINE void load_corners(const std::byte* codes, const Addresses& at, Corners& corners) {
    for (int ray = 0; ray < packet_rays; ++ray) {
        const std::size_t lower = place(0, at.lower[ray]);
        const std::size_t upper = place(0, at.upper[ray]);
        for (int c = 0; c < 4; ++c) {
            const std::size_t run = static_cast<std::size_t>(at.run[c][ray]) * grid::brick_edge;
            if (sizeof(Code) == 1 && at.paired) {
                // One load for two codes; they are taken apart eight at a time.
                corners.low[c][ray] = code_at<std::uint16_t>(codes + run + lower, 0);
            } else {
                corners.low[c][ray] = code_at<Code>(codes, run + lower);
                corners.high[c][ray] = code_at<Code>(codes, run + upper);
            }
        }
    }
}

HWY_INLINE void split_pairs(Corners& corners) {
    const Ints i;
    for (int c = 0; c < 4; ++c) {
        for (std::size_t ray = 0; ray < packet_rays; ray += hn::Lanes(i)) {
            const IntVec pair = hn::Load(i, corners.low[c] + ray);
            hn::Store(hn::And(pair, hn::Set(i, 0xFF)), i, corners.low[c] + ray);
            hn::Store(hn::ShiftRight<8>(pair), i, corners.high[c] + ray);
        }
    }
}

HWY_INLINE bool no_values(const Corners& corners) {
    const Ints i;
    IntVec largest = hn::Zero(i);
    for (int c = 0; c < 4; ++c) {
        for (std::size_t ray = 0; ray < packet_rays; ray += hn::Lanes(i)) {
            largest = hn::Max(largest, hn::Max(hn::Load(i, corners.low[c] + ray),
                                               hn::Load(i, corners.high[c] + ray)));
        }
    }
    return hn::AllFalse(i, hn::Gt(largest, hn::Set(i, grid::first_value_code - 1)));
}

template <bool curved>
class Caster {
  public:
    Caster(const PacketVolume& volume, const RayPacket& rays, float* rgba)
        : volume_(volume), rays_(rays), rgba_(rgba) {
        std::fill(rgba_, rgba_ + packet_rays * 4, 0.0F);
        std::fill(through_, through_ + packet_rays, 1.0F);
    }

    void cast(const std::uint64_t* mask, std::size_t words) {
        const float enter = *std::min_element(rays_.enter, rays_.enter + packet_rays);
        const float leave = *std::max_element(rays_.leave, rays_.leave + packet_rays);
        if (!(enter < leave)) return finish();
        const int first = static_cast<int>(enter);
        Samples samples[2];
        int back = 0;
        int last_done = -2;
        for (auto w = static_cast<std::size_t>(first) / 64; w < words; ++w) {
            for (std::uint64_t bits = mask[w]; bits != 0; bits &= bits - 1) {
                const int k = static_cast<int>(w) * 64 + std::countr_zero(bits);
                if (k < first) continue;
                if (static_cast<float>(k) >= leave) return finish();
                if (k != last_done + 1) sample(static_cast<float>(k), samples[back]);
                back ^= 1;
                sample(static_cast<float>(k + 1), samples[back]);
                last_done = k;
                add_step(samples[back ^ 1], samples[back], static_cast<float>(k));
                if (all_opaque_) return finish();
            }
        }
        finish();
    }

  private:
    // At slice t, or where the ray enters or leaves the box when that is nearer to its middle.
    HWY_INLINE void sample(float t, Samples& samples) {
        const Floats f;
        constexpr int lanes = static_cast<int>(hn::MaxLanes(Floats()));
        Addresses at;
        Between z_of[packet_rays / lanes];
        FloatVec x_weight[packet_rays / lanes];
        FloatVec y_weight[packet_rays / lanes];
        for (int part = 0; part < packet_rays / lanes; ++part) {
            const int ray = part * lanes;
            const FloatVec clipped =
                hn::Min(hn::Max(hn::Set(f, t), hn::LoadU(f, rays_.enter + ray)),
                        hn::LoadU(f, rays_.leave + ray));
            const auto position = [&](const float* start, const float* step) {
                return hn::Add(hn::LoadU(f, start + ray),
                               hn::Mul(clipped, hn::LoadU(f, step + ray)));
            };
            const FloatVec px = position(rays_.x, rays_.step_x);
            const FloatVec py = position(rays_.y, rays_.step_y);
            FloatVec pz = position(rays_.z, rays_.step_z);
            if constexpr (curved) pz = hn::Add(pz, drop(px, py));
            const Between x = between(px, volume_.last_x);
            const Between y = between(py, volume_.last_y);
            z_of[part] = between(level_of(pz), volume_.last_z);
            x_weight[part] = x.weight;
            y_weight[part] = y.weight;
            store_addresses(x, y, z_of[part], ray, at);
        }
        Corners corners;
        if (volume_.code_bytes == 1) {
            load_corners<std::uint8_t>(volume_.codes, at, corners);
            if (at.paired) split_pairs(corners);
        } else {
            load_corners<std::uint16_t>(volume_.codes, at, corners);
        }
        if (no_values(corners)) {
            std::fill(samples.valued, samples.valued + packet_rays, 0.0F);
            std::fill(samples.bin, samples.bin + packet_rays, 0);
            return;
        }
        for (int part = 0; part < packet_rays / lanes; ++part) {
            mix(corners, part * lanes, x_weight[part], y_weight[part], z_of[part].weight, samples);
        }
    }

    HWY_INLINE FloatVec drop(FloatVec x, FloatVec y) const {
        const Floats f;
        const FloatVec dx = hn::Sub(x, hn::Set(f, volume_.curve->middle_x));
        const FloatVec dy = hn::Sub(y, hn::Set(f, volume_.curve->middle_y));
        return hn::Add(hn::Mul(hn::Set(f, volume_.curve->curve_x), hn::Mul(dx, dx)),
                       hn::Mul(hn::Set(f, volume_.curve->curve_y), hn::Mul(dy, dy)));
    }

    HWY_INLINE FloatVec level_of(FloatVec z) const {
        if (volume_.levels == nullptr) return z;
        const Floats f;
        HWY_ALIGN float heights[packet_rays];
        hn::Store(z, f, heights);
        for (std::size_t lane = 0; lane < hn::Lanes(f); ++lane) {
            heights[lane] = (*volume_.levels)(heights[lane]);
        }
        return hn::Load(f, heights);
    }

    HWY_INLINE void store_addresses(const Between& x, const Between& y, const Between& z, int ray,
                                    Addresses& at) const {
        const Ints i;
        const IntVec x0 = runs_to<4>(x.cell, volume_.brick_stride_x);
        const IntVec x1 = runs_to<4>(x.next, volume_.brick_stride_x);
        const IntVec y0 = runs_to<0>(y.cell, volume_.brick_stride_y);
        const IntVec y1 = runs_to<0>(y.next, volume_.brick_stride_y);
        hn::Store(hn::Add(x0, y0), i, at.run[0] + ray);
        hn::Store(hn::Add(x1, y0), i, at.run[1] + ray);
        hn::Store(hn::Add(x0, y1), i, at.run[2] + ray);
        hn::Store(hn::Add(x1, y1), i, at.run[3] + ray);
        hn::Store(z.cell, i, at.lower + ray);
        hn::Store(z.next, i, at.upper + ray);
        const auto follows = hn::Eq(hn::Sub(z.next, z.cell), hn::Set(i, 1));
        const auto same_run = hn::Ne(hn::And(z.cell, hn::Set(i, grid::brick_edge - 1)),
                                     hn::Set(i, grid::brick_edge - 1));
        at.paired = at.paired && hn::AllTrue(i, hn::And(follows, same_run));
    }

    // The mean of the valued cells, as a bin, and their share.
    HWY_INLINE void mix(const Corners& corners, int ray, FloatVec x1, FloatVec y1, FloatVec z1,
                        Samples& samples) const {
        const Floats f;
        const Ints i;
        const FloatVec one = hn::Set(f, 1.0F);
        const FloatVec x0 = hn::Sub(one, x1);
        const FloatVec y0 = hn::Sub(one, y1);
        const FloatVec z0 = hn::Sub(one, z1);
        const FloatVec column[4] = {hn::Mul(x0, y0), hn::Mul(x1, y0), hn::Mul(x0, y1),
                                    hn::Mul(x1, y1)};
        FloatVec sum = hn::Zero(f);
        FloatVec valued = hn::Zero(f);
        const auto add = [&](const std::int32_t* codes, FloatVec weight) {
            const IntVec code = hn::Load(i, codes + ray);
            const auto counts =
                hn::RebindMask(f, hn::Gt(code, hn::Set(i, grid::first_value_code - 1)));
            const FloatVec share = hn::IfThenElseZero(counts, weight);
            valued = hn::Add(valued, share);
            sum = hn::Add(sum, hn::Mul(share, hn::ConvertTo(f, code)));
        };
        for (int c = 0; c < 4; ++c) {
            add(corners.low[c], hn::Mul(column[c], z0));
            add(corners.high[c], hn::Mul(column[c], z1));
        }
        const FloatVec some = hn::IfThenElse(hn::Gt(valued, hn::Zero(f)), valued, one);
        const FloatVec position =
            hn::Add(hn::Set(f, volume_.transfer->bin_offset()),
                    hn::Mul(hn::Set(f, volume_.transfer->bin_slope()), hn::Div(sum, some)));
        const FloatVec bounded =
            hn::Min(hn::Max(position, hn::Zero(f)), hn::Set(f, TransferFunction::bin_count - 1.0F));
        hn::Store(hn::ConvertTo(i, bounded), i, samples.bin + ray);
        hn::Store(valued, f, samples.valued + ray);
    }

    // The step from slice k to the next; an end without a value takes that of the other.
    HWY_INLINE void add_step(const Samples& front, const Samples& back, float k) {
        const Floats f;
        HWY_ALIGN float length[packet_rays];
        bool any = false;
        for (std::size_t part = 0; part < packet_rays; part += hn::Lanes(f)) {
            const FloatVec valued =
                hn::Add(hn::Load(f, front.valued + part), hn::Load(f, back.valued + part));
            const FloatVec from = hn::Max(hn::Set(f, k), hn::LoadU(f, rays_.enter + part));
            const FloatVec to = hn::Min(hn::Set(f, k + 1), hn::LoadU(f, rays_.leave + part));
            const FloatVec inside = hn::Max(hn::Sub(to, from), hn::Zero(f));
            const FloatVec share = hn::Mul(hn::Set(f, 0.5F), valued);
            const FloatVec counts =
                hn::Mul(hn::Mul(inside, share), hn::LoadU(f, rays_.length + part));
            hn::Store(counts, f, length + part);
            any = any || !hn::AllFalse(f, hn::Gt(counts, hn::Zero(f)));
        }
        if (any) add_entries(front, back, length);
    }

    HWY_INLINE void add_entries(const Samples& front, const Samples& back, const float* length) {
        const Floats f;
        const TransferEntry* entries[packet_rays];
        HWY_ALIGN float depth[packet_rays];
        for (int ray = 0; ray < packet_rays; ++ray) {
            const int one = front.valued[ray] > 0 ? front.bin[ray] : back.bin[ray];
            const int other = back.valued[ray] > 0 ? back.bin[ray] : front.bin[ray];
            entries[ray] = &volume_.transfer->entry(one, other);
            depth[ray] = entries[ray]->depth * length[ray];
        }
        HWY_ALIGN float seen[packet_rays];
        bool all_opaque = true;
        for (std::size_t part = 0; part < packet_rays; part += hn::Lanes(f)) {
            const FloatVec through = hn::Load(f, through_ + part);
            const FloatVec taken = hn::Mul(through, opacity_of(hn::Load(f, depth + part)));
            const FloatVec left = hn::Sub(through, taken);
            hn::Store(taken, f, seen + part);
            hn::Store(left, f, through_ + part);
            all_opaque = all_opaque && hn::AllTrue(f, hn::Lt(left, hn::Set(f, opaque_enough)));
        }
        all_opaque_ = all_opaque;
        for (int ray = 0; ray < packet_rays; ++ray) {
            float* pixel = rgba_ + ray * 4;
            pixel[0] += seen[ray] * entries[ray]->red;
            pixel[1] += seen[ray] * entries[ray]->green;
            pixel[2] += seen[ray] * entries[ray]->blue;
        }
    }

    void finish() {
        for (int ray = 0; ray < packet_rays; ++ray)
            rgba_[ray * 4 + 3] = 1 - through_[ray];
    }

    const PacketVolume& volume_;
    const RayPacket& rays_;
    float* rgba_;
    HWY_ALIGN float through_[packet_rays];
    bool all_opaque_ = false;
};

void cast_one_packet(const PacketVolume& volume, const RayPacket& rays, const std::uint64_t* mask,
                     std::size_t words, float* rgba) {
    if (volume.curve != nullptr) {
        Caster<true>(volume, rays, rgba).cast(mask, words);
    } else {
        Caster<false>(volume, rays, rgba).cast(mask, words);
    }
}

}  // namespace stormcellar::render::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace stormcellar::render {

HWY_EXPORT(cast_one_packet);

PacketVolume::PacketVolume(const grid::BrickView& view, const LevelPosition& level_position,
                           const TransferFunction& transfer_function)
    : codes(view.codes.data()),
      code_bytes(view.quantization.code_bytes),
      brick_stride_x(view.bricks_y * view.bricks_z * grid::brick_edge * grid::brick_edge),
      brick_stride_y(view.bricks_z * grid::brick_edge * grid::brick_edge),
      last_x(view.spec->nx - 1),
      last_y(view.spec->ny - 1),
      last_z(view.spec->nz() - 1),
      levels(level_position.is_uniform() ? nullptr : &level_position),
      transfer(&transfer_function) {}

bool PacketVolume::can_address(const grid::BrickView& view) {
    const double runs = static_cast<double>(view.bricks_x) * view.bricks_y * view.bricks_z *
                        grid::brick_edge * grid::brick_edge;
    return runs <= std::numeric_limits<std::int32_t>::max();
}

void cast_packet(const PacketVolume& volume, const RayPacket& rays, const std::uint64_t* mask,
                 std::size_t words, float* rgba) {
    HWY_DYNAMIC_DISPATCH(cast_one_packet)(volume, rays, mask, words, rgba);
}

}  // namespace stormcellar::render
#endif
