// render/volume/lanes-inl.h -- defines vectors of numbers, with one lane for each of several rays.
//
// This file is a part of render/volume/ray_packet.cpp, which is compiled once for each SIMD target.
// A ray's result does not depend on the rays beside it. So the number of lanes, which differs
// between targets, changes no bit.
#if defined(STORMCELLAR_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef STORMCELLAR_LANES_INL
#undef STORMCELLAR_LANES_INL
#else
#define STORMCELLAR_LANES_INL
#endif

#include <cstdint>
#include <cstring>

#include <hwy/highway.h>

#include "render/volume/ray_packet.h"

HWY_BEFORE_NAMESPACE();
namespace stormcellar::render::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, packet_rays>;
using Ints = hn::RebindToSigned<Floats>;
using FloatVec = hn::Vec<Floats>;
using IntVec = hn::Vec<Ints>;
constexpr int lanes = static_cast<int>(hn::MaxLanes(Floats()));

template <class Number>
HWY_INLINE Number load_as(const std::byte* from) {
    Number number;
    std::memcpy(&number, from, sizeof(Number));
    return number;
}

// Stores a vector, so that its numbers can be read one by one. The asm statement keeps compilers
// from replacing these reads by shuffles, which are slower.
class LaneNumbers {
  public:
    HWY_INLINE explicit LaneNumbers(IntVec numbers) {
        hn::Store(numbers, Ints(), numbers_);
        asm("" : "+m"(numbers_));
    }
    HWY_INLINE std::int64_t operator[](int lane) const { return numbers_[lane]; }

  private:
    HWY_ALIGN std::int32_t numbers_[lanes];
};

// The lower and the upper halves of one number of 64 bits for each lane.
struct Halves {
    IntVec low, high;
};

#if HWY_TARGET == HWY_SCALAR
template <class Word>
HWY_INLINE Halves halves_of(Word word) {
    const std::uint64_t bits = word(0);
    const Ints i;
    return {hn::Set(i, static_cast<std::int32_t>(bits & 0xFFFFFFFF)),
            hn::Set(i, static_cast<std::int32_t>(bits >> 32))};
}
#else

// Makes a vector of `width` lanes from 128-bit blocks: block(first), block(first + 4) and so on.
template <int width, class Block>
HWY_INLINE auto blocks_from(int first, Block block) {
    if constexpr (width == 4) {
        return block(first);
    } else {
        const auto low = blocks_from<width / 2>(first, block);
        const auto high = blocks_from<width / 2>(first + width / 2, block);
        const hn::CappedTag<hn::TFromV<decltype(low)>,
                            width * sizeof(float) / sizeof(hn::TFromV<decltype(low)>)>
            whole;
        return hn::Combine(whole, high, low);
    }
}

// Returns the halves of word(lane) for all lanes. Everything stays in registers, because a vector
// must not be read from memory right after its numbers were stored one by one: the read would wait.
template <class Word>
HWY_INLINE Halves halves_of(Word word) {
    const hn::Full64<std::uint64_t> one;
    const hn::Full128<std::uint64_t> two;
    const auto pair = [&](int lane) {
        return hn::Combine(two, hn::Set(one, word(lane + 1)), hn::Set(one, word(lane)));
    };
    // Each block of 128 bits has the numbers of lanes 0 and 1, or of lanes 2 and 3.
    const Ints i;
    const IntVec a = hn::BitCast(i, blocks_from<lanes>(0, pair));
    const IntVec b = hn::BitCast(i, blocks_from<lanes>(2, pair));
    const IntVec even = hn::InterleaveLower(i, a, b), odd = hn::InterleaveUpper(i, a, b);
    return {hn::InterleaveLower(i, even, odd), hn::InterleaveUpper(i, even, odd)};
}
#endif

// Loads four consecutive numbers for each lane from entry(lane), and sorts them into four vectors.
struct Fours {
    FloatVec first, second, third, fourth;
};

#if HWY_TARGET == HWY_SCALAR
template <class Entry>
HWY_INLINE Fours fours_of(Entry entry) {
    const float* at = entry(0);
    const Floats f;
    return {hn::Set(f, at[0]), hn::Set(f, at[1]), hn::Set(f, at[2]), hn::Set(f, at[3])};
}
#else
template <class Entry>
HWY_INLINE Fours fours_of(Entry entry) {
    const Floats f;
    const hn::Full128<float> quad;
    const auto block = [&](int lane) { return hn::LoadU(quad, entry(lane)); };
    const FloatVec a = blocks_from<lanes>(0, block), b = blocks_from<lanes>(1, block);
    const FloatVec c = blocks_from<lanes>(2, block), d = blocks_from<lanes>(3, block);
    // Transposes four by four in each block of 128 bits.
    const FloatVec ac_low = hn::InterleaveLower(f, a, c), ac_high = hn::InterleaveUpper(f, a, c);
    const FloatVec bd_low = hn::InterleaveLower(f, b, d), bd_high = hn::InterleaveUpper(f, b, d);
    return {hn::InterleaveLower(f, ac_low, bd_low), hn::InterleaveUpper(f, ac_low, bd_low),
            hn::InterleaveLower(f, ac_high, bd_high), hn::InterleaveUpper(f, ac_high, bd_high)};
}
#endif

}  // namespace stormcellar::render::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
