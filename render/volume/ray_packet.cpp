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
// This include must come after foreach_target.h, which compiles this file once for each target.
#include <hwy/highway.h>

#include "render/volume/ray_light-inl.h"

HWY_BEFORE_NAMESPACE();
namespace stormcellar::render::HWY_NAMESPACE {

constexpr float opaque_enough = 0.001F;  // a ray ends if less light than this gets through

// Returns 1 - exp(-depth), within 2e-7, for depths of 0 and more. exp() of the library would give
// other bits on other targets, because of its fused operations.
HWY_INLINE FloatVec opacity_of(FloatVec depth) {
    const Floats f;
    const Ints i;
    constexpr float log2_e = 1.44269504F;
    // exp(-depth) = 2^-whole * 2^-part, with part within -1/2 to 1/2.
    const FloatVec exponent = hn::Min(hn::Mul(depth, hn::Set(f, log2_e)), hn::Set(f, 120.0F));
    const IntVec whole = hn::ConvertTo(i, hn::Add(exponent, hn::Set(f, 0.5F)));
    const FloatVec part = hn::Sub(hn::ConvertTo(f, whole), exponent);
    // 2^part is a polynomial with the coefficients ln(2)^n / n!. Its terms are added in pairs, so
    // that few operations wait for other operations.
    const auto term = [&](float constant, float slope) {
        return hn::Add(hn::Set(f, constant), hn::Mul(hn::Set(f, slope), part));
    };
    const FloatVec square = hn::Mul(part, part);
    const FloatVec low =
        hn::Add(term(1.0F, 6.9314718e-1F), hn::Mul(term(2.4022651e-1F, 5.5504109e-2F), square));
    const FloatVec high =
        hn::Add(term(9.6181291e-3F, 1.3333558e-3F), hn::Mul(hn::Set(f, 1.5403530e-4F), square));
    const FloatVec power = hn::Add(low, hn::Mul(high, hn::Mul(square, square)));
    // 2^-whole is a float whose exponent is -whole, so set its bits directly.
    const IntVec scale = hn::ShiftLeft<23>(hn::Sub(hn::Set(i, 127), whole));
    return hn::Sub(hn::Set(f, 1.0F), hn::Mul(power, hn::BitCast(f, scale)));
}

// The rays of a packet that are in the lanes of one vector.
struct Rays {
    FloatVec x, y, z, step_x, step_y, step_z, length, enter, leave;

    Rays(const RayPacket& rays, int first) {
        const Floats f;
        const auto load = [&](const float* numbers) { return hn::LoadU(f, numbers + first); };
        x = load(rays.x);
        y = load(rays.y);
        z = load(rays.z);
        step_x = load(rays.step_x);
        step_y = load(rays.step_y);
        step_z = load(rays.step_z);
        length = load(rays.length);
        enter = load(rays.enter);
        leave = load(rays.leave);
    }
};

// The values that the rays find at one slice.
struct SliceFinds {
    HWY_ALIGN std::int32_t bin[lanes];
    HWY_ALIGN float valued[lanes];
    float t = 0;          // the slice
    bool any = false;     // some ray found a value
    bool joined = false;  // this slice and the previous one are the two ends of a step
};

// Lists the slices at both ends of the steps whose bits are set. Two consecutive marked steps share
// the slice between them, which is listed only once.
class MarkedSlices {
  public:
    HWY_INLINE MarkedSlices(const std::uint64_t* mask, std::size_t words, int first, float leave)
        : mask_(mask),
          words_(words),
          word_(static_cast<std::size_t>(first) / 64),
          leave_(leave),
          bits_(word_ < words ? mask[word_] & ~std::uint64_t{0} << (first % 64) : 0) {}

    // Returns false after the last slice. Sets `joined` if this slice and the previous one are the
    // two ends of a step.
    HWY_INLINE bool next(float& t, bool& joined) {
        // The last result was the near end of this step, so its far end comes now.
        if (half_done_) {
            half_done_ = false;
            joined = true;
            t = static_cast<float>(++last_);
            return true;
        }
        // The next set bit is the next step to be sampled.
        while (bits_ == 0) {
            if (++word_ >= words_) return false;
            bits_ = mask_[word_];
        }
        const int step = static_cast<int>(word_) * 64 + std::countr_zero(bits_);
        if (static_cast<float>(step) >= leave_) return false;
        // If the step begins at the last slice, only its far end is new. Otherwise its near end
        // comes now, and its far end comes in the next call.
        bits_ &= bits_ - 1;
        joined = step == last_;
        half_done_ = !joined;
        last_ = joined ? step + 1 : step;
        t = static_cast<float>(last_);
        return true;
    }

  private:
    const std::uint64_t* mask_;
    std::size_t words_, word_;
    float leave_;
    std::uint64_t bits_;
    int last_ = -1;           // the last slice that was returned
    bool half_done_ = false;  // only the near end of the last step was returned
};

// Casts the rays of one vector from front to back. Slices are sampled in batches, and the steps of
// a batch are added up after the batch. Within a batch no sample waits for another sample, so the
// processor works on several samples at once. `Source` reads the codes. Options that a scene does
// not use are not compiled in.
template <class Source, bool curved, bool lit>
class Caster {
  public:
    HWY_INLINE Caster(const PacketVolume& volume, const RayPacket& rays, int first)
        : volume_(volume),
          rays_(rays, first),
          entries_(reinterpret_cast<const std::byte*>(&volume.transfer->entry(0, 0))) {
        const Floats f;
        through_ = hn::Set(f, 1.0F);
        red_ = green_ = blue_ = light_sum_ = light_ = hn::Zero(f);
        enter_ = *std::min_element(rays.enter + first, rays.enter + first + lanes);
        leave_ = *std::max_element(rays.leave + first, rays.leave + first + lanes);
    }

    HWY_INLINE void cast(const std::uint64_t* mask, std::size_t words) {
        if (!(enter_ < leave_)) return;
        MarkedSlices slices(mask, words, static_cast<int>(enter_), leave_);
        SliceFinds finds[batch + 1];  // finds[0] is the last slice of the previous batch
        int count = batch;
        while (count == batch) {
            count = 0;
            while (count < batch && slices.next(finds[count + 1].t, finds[count + 1].joined))
                ++count;
            if (take_batch(finds, count)) return;
            finds[0] = finds[count];
        }
    }

    HWY_INLINE void store(float* rgba, float* light) const {
        const Floats f;
        hn::StoreInterleaved4(red_, green_, blue_, hn::Sub(hn::Set(f, 1.0F), through_), f, rgba);
        if constexpr (lit) hn::StoreU(light_sum_, f, light);
    }

  private:
    static constexpr int batch = 8;

    // Samples a batch and adds up its steps. Returns true if no more light gets through.
    HWY_INLINE bool take_batch(SliceFinds* finds, int count) {
        for (int slice = 1; slice <= count; ++slice)
            take_samples(finds[slice]);
        // A step that has no value at either end adds nothing.
        for (int slice = 1; slice <= count; ++slice) {
            const SliceFinds& front = finds[slice - 1];
            const SliceFinds& back = finds[slice];
            if (!back.joined || (!front.any && !back.any)) continue;
            if (add_step(front, back)) return true;
        }
        return false;
    }

    // Takes the samples at a slice. If a ray enters or leaves the box between two slices, its
    // sample is taken at that point instead.
    HWY_INLINE void take_samples(SliceFinds& finds) const {
        const Floats f;
        const Positions where = positions_at(finds.t);
        const Places at{place_of(where.x, volume_.last_x), place_of(where.y, volume_.last_y),
                        place_of(where.level, volume_.last_z)};
        const Corners corners = Source::corners(volume_, at);
        Samples samples;
        finds.any = mix_corners(volume_, corners, at, samples);
        hn::Store(samples.bin, Ints(), finds.bin);
        hn::Store(samples.valued, f, finds.valued);
    }

    // The places of the rays at a slice, in cells and levels.
    struct Positions {
        FloatVec x, y, level;
    };
    HWY_INLINE Positions positions_at(float t) const {
        const Floats f;
        const FloatVec held = hn::Min(hn::Max(hn::Set(f, t), rays_.enter), rays_.leave);
        const FloatVec x = hn::Add(rays_.x, hn::Mul(held, rays_.step_x));
        const FloatVec y = hn::Add(rays_.y, hn::Mul(held, rays_.step_y));
        FloatVec z = hn::Add(rays_.z, hn::Mul(held, rays_.step_z));
        if constexpr (curved) z = hn::Add(z, drop(*volume_.curve, x, y));
        return {x, y, level_of(volume_, z)};
    }

    // Adds the light of a step, times the part of the step that is seen. The light changes little
    // from slice to slice, so it is read only at the end that has an even number, which two steps
    // share.
    HWY_INLINE void add_light(float front_t, FloatVec seen) {
        const int front = static_cast<int>(front_t);
        const int even = front + (front & 1);
        if (even != light_slice_) {
            const Positions where = positions_at(static_cast<float>(even));
            light_ = light_at(*volume_.light, where.x, where.y, where.level);
            light_slice_ = even;
        }
        light_sum_ = hn::Add(light_sum_, hn::Mul(seen, light_));
    }

    // Adds the step between two slices. The bins at its two ends select an entry of the transfer
    // function. If one end has no value, the bin of the other end is used for both.
    HWY_INLINE bool add_step(const SliceFinds& front, const SliceFinds& back) {
        const Floats f;
        const Ints i;
        // The length of the step is that of the ray inside the box. The length is multiplied by the
        // mean share of cells with values at the two ends, so that echo tapers to nothing.
        const FloatVec from = hn::Max(hn::Set(f, front.t), rays_.enter);
        const FloatVec to = hn::Min(hn::Set(f, back.t), rays_.leave);
        const FloatVec inside = hn::Max(hn::Sub(to, from), hn::Zero(f));
        const FloatVec front_share = hn::Load(f, front.valued);
        const FloatVec back_share = hn::Load(f, back.valued);
        const FloatVec share = hn::Mul(hn::Set(f, 0.5F), hn::Add(front_share, back_share));
        const FloatVec length = hn::Mul(hn::Mul(inside, share), rays_.length);
        const auto in_front = hn::Gt(front_share, hn::Zero(f));
        const auto behind = hn::Gt(back_share, hn::Zero(f));
        const IntVec front_bin = hn::Load(i, front.bin);
        const IntVec back_bin = hn::Load(i, back.bin);
        const IntVec one = hn::IfThenElse(hn::RebindMask(i, in_front), front_bin, back_bin);
        const IntVec other = hn::IfThenElse(hn::RebindMask(i, behind), back_bin, front_bin);
        // Each lane loads its entry of the table: red, green, blue and depth are consecutive.
        constexpr int entry_bits = std::countr_zero(sizeof(TransferEntry));
        const LaneNumbers at(hn::ShiftLeft<entry_bits>(hn::Add(hn::ShiftLeft<8>(one), other)));
        const Fours looks =
            fours_of([&](int lane) { return reinterpret_cast<const float*>(entries_ + at[lane]); });
        return add_looks(looks, length, front.t);
    }

    // Composites a step over the earlier steps, front to back. The step adds its color, times its
    // opacity, times the light that still gets through, and takes its share of that light. `looks`
    // is red, green, blue and optical depth for each reference length.
    HWY_INLINE bool add_looks(const Fours& looks, FloatVec length, float front_t) {
        const Floats f;
        const FloatVec enough = hn::Set(f, opaque_enough);
        const FloatVec open = hn::IfThenElseZero(hn::Ge(through_, enough), through_);
        const FloatVec seen = hn::Mul(open, opacity_of(hn::Mul(looks.fourth, length)));
        red_ = hn::Add(red_, hn::Mul(seen, looks.first));
        green_ = hn::Add(green_, hn::Mul(seen, looks.second));
        blue_ = hn::Add(blue_, hn::Mul(seen, looks.third));
        through_ = hn::Sub(through_, seen);
        if constexpr (lit) {
            if (!hn::AllTrue(f, hn::Eq(seen, hn::Zero(f)))) add_light(front_t, seen);
        }
        return hn::AllTrue(f, hn::Lt(through_, enough));
    }

    const PacketVolume& volume_;
    const Rays rays_;
    const std::byte* entries_;
    float enter_, leave_;
    FloatVec through_, red_, green_, blue_;
    FloatVec light_sum_, light_;
    int light_slice_ = -1;  // the slice of light_
};

template <class Source, bool curved, bool lit>
HWY_INLINE void cast_as(const PacketVolume& volume, const RayPacket& rays,
                        const std::uint64_t* mask, std::size_t words, float* rgba, float* light) {
    for (int first = 0; first < packet_rays; first += lanes) {
        Caster<Source, curved, lit> caster(volume, rays, first);
        caster.cast(mask, words);
        caster.store(rgba + first * 4, light + first);
    }
}

template <class Source>
HWY_INLINE void cast_from(const PacketVolume& volume, const RayPacket& rays,
                          const std::uint64_t* mask, std::size_t words, float* rgba, float* light) {
    const bool lit = volume.light != nullptr;
    if (volume.curve != nullptr) {
        lit ? cast_as<Source, true, true>(volume, rays, mask, words, rgba, light)
            : cast_as<Source, true, false>(volume, rays, mask, words, rgba, light);
    } else {
        lit ? cast_as<Source, false, true>(volume, rays, mask, words, rgba, light)
            : cast_as<Source, false, false>(volume, rays, mask, words, rgba, light);
    }
}

void cast_one_packet(const PacketVolume& volume, const RayPacket& rays, const std::uint64_t* mask,
                     std::size_t words, float* rgba, float* light) {
    volume.words != nullptr ? cast_from<FromTable>(volume, rays, mask, words, rgba, light)
                            : cast_from<FromBricks>(volume, rays, mask, words, rgba, light);
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
      last_state(view.quantization.first_code() - 1),
      brick_stride_x(view.bricks_y * view.bricks_z * static_cast<int>(grid::brick_cells)),
      brick_stride_y(view.bricks_z * static_cast<int>(grid::brick_cells)),
      last_x(view.spec->nx - 1),
      last_y(view.spec->ny - 1),
      last_z(view.spec->nz() - 1),
      levels(level_position.is_uniform() ? nullptr : &level_position),
      transfer(&transfer_function) {}

PacketLight::PacketLight(const ShadeField& field)
    : words(field.words()),
      stride_x(field.stride_x()),
      stride_y(field.stride_y()),
      last_x(field.size(0) - 1),
      last_y(field.size(1) - 1),
      last_z(field.size(2) - 1) {}

void PacketVolume::use(const CornerTable& table) {
    words = table.words();
    word_stride_x = table.stride_x();
    word_stride_y = table.stride_y();
}

bool PacketVolume::can_address(const grid::BrickView& view) {
    const double codes = static_cast<double>(view.bricks_x) * view.bricks_y * view.bricks_z *
                         static_cast<double>(grid::brick_cells);
    return codes <= std::numeric_limits<std::int32_t>::max();
}

void cast_packet(const PacketVolume& volume, const RayPacket& rays, const std::uint64_t* mask,
                 std::size_t words, float* rgba, float* light) {
    HWY_DYNAMIC_DISPATCH(cast_one_packet)(volume, rays, mask, words, rgba, light);
}

}  // namespace stormcellar::render
#endif
