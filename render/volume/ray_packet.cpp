#include "render/volume/ray_packet.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/volume/ray_packet.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, which compiles this file once for each target.
#include <hwy/highway.h>

#include "render/volume/ray_light-inl.h"

HWY_BEFORE_NAMESPACE();
namespace stormcellar::render::HWY_NAMESPACE {

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

// Entries of the transfer function, taken apart.
struct Looks {
    FloatVec red, green, blue, depth;
};

// Those at indices[0] and on, one for each lane.
#if HWY_TARGET == HWY_SCALAR
HWY_INLINE Looks looks_at(const TransferEntry* entries, const std::int32_t* indices) {
    const TransferEntry& entry = entries[indices[0]];
    const Floats f;
    return {hn::Set(f, entry.red), hn::Set(f, entry.green), hn::Set(f, entry.blue),
            hn::Set(f, entry.depth)};
}
#else
template <int width = lanes>
HWY_INLINE Looks looks_at(const TransferEntry* entries, const std::int32_t* indices) {
    const Floats f;
    const hn::Full128<float> quad;  // one entry
    const auto load = [&](int lane) {
        return hn::LoadU(quad, reinterpret_cast<const float*>(entries + indices[lane]));
    };
    const auto entry = [&](int lane) {
        if constexpr (width == 8) {
            return hn::Combine(f, load(lane + 4), load(lane));
        } else {
            return load(lane);
        }
    };
    // Four by four, in each block of 128 bits.
    const FloatVec a = entry(0), b = entry(1), c = entry(2), d = entry(3);
    const FloatVec ac_low = hn::InterleaveLower(f, a, c), ac_high = hn::InterleaveUpper(f, a, c);
    const FloatVec bd_low = hn::InterleaveLower(f, b, d), bd_high = hn::InterleaveUpper(f, b, d);
    return {hn::InterleaveLower(f, ac_low, bd_low), hn::InterleaveUpper(f, ac_low, bd_low),
            hn::InterleaveLower(f, ac_high, bd_high), hn::InterleaveUpper(f, ac_high, bd_high)};
}
#endif

template <bool curved, bool lit>
class Caster {
  public:
    Caster(const PacketVolume& volume, const RayPacket& rays)
        : volume_(volume), rays_(rays), entries_(&volume.transfer->entry(0, 0)) {
        const Floats f;
        for (int part = 0; part < parts; ++part) {
            through_[part] = hn::Set(f, 1.0F);
            red_[part] = green_[part] = blue_[part] = hn::Zero(f);
        }
    }

    void cast(const std::uint64_t* mask, std::size_t words) {
        const float enter = *std::min_element(rays_.enter, rays_.enter + packet_rays);
        const float leave = *std::max_element(rays_.leave, rays_.leave + packet_rays);
        if (!(enter < leave)) return;
        const int first = static_cast<int>(enter);
        Samples samples[2];
        int back = 0;
        int last_done = -2;
        for (auto w = static_cast<std::size_t>(first) / 64; w < words; ++w) {
            for (std::uint64_t bits = mask[w]; bits != 0; bits &= bits - 1) {
                const int k = static_cast<int>(w) * 64 + std::countr_zero(bits);
                if (k < first) continue;
                if (static_cast<float>(k) >= leave) return;
                if (k != last_done + 1) {
                    take_samples<curved, lit>(volume_, rays_, static_cast<float>(k), samples[back]);
                }
                back ^= 1;
                take_samples<curved, lit>(volume_, rays_, static_cast<float>(k + 1), samples[back]);
                last_done = k;
                if (!samples[0].any && !samples[1].any) continue;
                if (add_step(samples[back ^ 1], samples[back], static_cast<float>(k))) return;
            }
        }
    }

    void store(float* rgba) const {
        const Floats f;
        for (int part = 0; part < parts; ++part) {
            hn::StoreInterleaved4(red_[part], green_[part], blue_[part],
                                  hn::Sub(hn::Set(f, 1.0F), through_[part]), f,
                                  rgba + part * lanes * 4);
        }
    }

  private:
    // The step from slice k to the next; an end without a value takes that of the other. True when
    // no light comes through any more.
    HWY_INLINE bool add_step(const Samples& front, const Samples& back, float k) {
        const Floats f;
        const Ints i;
        bool all_opaque = true;
        for (int part = 0; part < parts; ++part) {
            const int ray = part * lanes;
            const FloatVec from = hn::Max(hn::Set(f, k), hn::LoadU(f, rays_.enter + ray));
            const FloatVec to = hn::Min(hn::Set(f, k + 1), hn::LoadU(f, rays_.leave + ray));
            const FloatVec inside = hn::Max(hn::Sub(to, from), hn::Zero(f));
            const FloatVec front_share = hn::Load(f, front.valued + ray);
            const FloatVec back_share = hn::Load(f, back.valued + ray);
            const FloatVec share = hn::Mul(hn::Set(f, 0.5F), hn::Add(front_share, back_share));
            const FloatVec length =
                hn::Mul(hn::Mul(inside, share), hn::LoadU(f, rays_.length + ray));
            if (hn::AllFalse(f, hn::Gt(length, hn::Zero(f)))) {
                all_opaque = false;
                continue;
            }
            const IntVec front_bin = hn::Load(i, front.bin + ray);
            const IntVec back_bin = hn::Load(i, back.bin + ray);
            const auto valued = [&](FloatVec part_share) {
                return hn::RebindMask(i, hn::Gt(part_share, hn::Zero(f)));
            };
            const IntVec one = hn::IfThenElse(valued(front_share), front_bin, back_bin);
            const IntVec other = hn::IfThenElse(valued(back_share), back_bin, front_bin);
            HWY_ALIGN std::int32_t indices[lanes];
            hn::Store(hn::Add(hn::ShiftLeft<8>(one), other), i, indices);
            Looks looks = looks_at(entries_, indices);
            if constexpr (lit) {
                const FloatVec front_light = hn::Load(f, front.light + ray);
                const FloatVec back_light = hn::Load(f, back.light + ray);
                const auto in_front = hn::Gt(front_share, hn::Zero(f));
                const auto behind = hn::Gt(back_share, hn::Zero(f));
                darken(looks, hn::Mul(hn::Set(f, 0.5F),
                                      hn::Add(hn::IfThenElse(in_front, front_light, back_light),
                                              hn::IfThenElse(behind, back_light, front_light))));
            }
            all_opaque = add_looks(looks, length, part) && all_opaque;
        }
        return all_opaque;
    }

    HWY_INLINE void darken(Looks& looks, FloatVec light) {
        looks.red = hn::Mul(looks.red, light);
        looks.green = hn::Mul(looks.green, light);
        looks.blue = hn::Mul(looks.blue, light);
    }

    HWY_INLINE bool add_looks(const Looks& looks, FloatVec length, int part) {
        const Floats f;
        const FloatVec seen = hn::Mul(through_[part], opacity_of(hn::Mul(looks.depth, length)));
        red_[part] = hn::Add(red_[part], hn::Mul(seen, looks.red));
        green_[part] = hn::Add(green_[part], hn::Mul(seen, looks.green));
        blue_[part] = hn::Add(blue_[part], hn::Mul(seen, looks.blue));
        through_[part] = hn::Sub(through_[part], seen);
        return hn::AllTrue(f, hn::Lt(through_[part], hn::Set(f, opaque_enough)));
    }

    const PacketVolume& volume_;
    const RayPacket& rays_;
    const TransferEntry* entries_;
    FloatVec through_[parts], red_[parts], green_[parts], blue_[parts];
};

template <bool curved, bool lit>
HWY_INLINE void cast_as(const PacketVolume& volume, const RayPacket& rays,
                        const std::uint64_t* mask, std::size_t words, float* rgba) {
    Caster<curved, lit> caster(volume, rays);
    caster.cast(mask, words);
    caster.store(rgba);
}

void cast_one_packet(const PacketVolume& volume, const RayPacket& rays, const std::uint64_t* mask,
                     std::size_t words, float* rgba) {
    const bool lit = volume.light != nullptr;
    if (volume.curve != nullptr) {
        lit ? cast_as<true, true>(volume, rays, mask, words, rgba)
            : cast_as<true, false>(volume, rays, mask, words, rgba);
    } else {
        lit ? cast_as<false, true>(volume, rays, mask, words, rgba)
            : cast_as<false, false>(volume, rays, mask, words, rgba);
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
      brick_stride_x(view.bricks_y * view.bricks_z * static_cast<int>(grid::brick_cells)),
      brick_stride_y(view.bricks_z * static_cast<int>(grid::brick_cells)),
      last_x(view.spec->nx - 1),
      last_y(view.spec->ny - 1),
      last_z(view.spec->nz() - 1),
      levels(level_position.is_uniform() ? nullptr : &level_position),
      transfer(&transfer_function) {}

bool PacketVolume::can_address(const grid::BrickView& view) {
    const double codes = static_cast<double>(view.bricks_x) * view.bricks_y * view.bricks_z *
                         static_cast<double>(grid::brick_cells);
    return codes <= std::numeric_limits<std::int32_t>::max();
}

void cast_packet(const PacketVolume& volume, const RayPacket& rays, const std::uint64_t* mask,
                 std::size_t words, float* rgba) {
    HWY_DYNAMIC_DISPATCH(cast_one_packet)(volume, rays, mask, words, rgba);
}

}  // namespace stormcellar::render
#endif
