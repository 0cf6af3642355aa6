// render/volume/code_vector-inl.h -- eight 16-bit codes, one for each ray of a packet.
//
// Part of render/volume/ray_packet.cpp, compiled once for each SIMD target. A machine without
// vectors of eight 16-bit numbers has an array.
#if defined(STORMCELLAR_CODE_VECTOR_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef STORMCELLAR_CODE_VECTOR_INL
#undef STORMCELLAR_CODE_VECTOR_INL
#else
#define STORMCELLAR_CODE_VECTOR_INL
#endif

#include <algorithm>
#include <array>
#include <cstdint>

#include <hwy/highway.h>

#include "render/volume/ray_packet.h"

HWY_BEFORE_NAMESPACE();
namespace stormcellar::render::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, packet_rays>;
using Ints = hn::RebindToSigned<Floats>;
using FloatVec = hn::Vec<Floats>;
using IntVec = hn::Vec<Ints>;
// A packet is `parts` vectors of `lanes` numbers.
constexpr int lanes = static_cast<int>(hn::MaxLanes(Floats()));
constexpr int parts = packet_rays / lanes;

#if HWY_TARGET == HWY_SCALAR

using CodeVec = std::array<std::uint16_t, packet_rays>;

template <class Change>
HWY_INLINE CodeVec changed(CodeVec codes, Change change) {
    for (std::size_t i = 0; i < codes.size(); ++i)
        codes[i] = static_cast<std::uint16_t>(change(codes[i], i));
    return codes;
}
HWY_INLINE CodeVec codes_of(std::uint64_t first_four, std::uint64_t last_four) {
    return changed({}, [&](int, std::size_t i) {
        return (i < 4 ? first_four : last_four) >> (i % 4 * 16) & 0xFFFF;
    });
}
HWY_INLINE CodeVec low_bytes(CodeVec codes) {
    return changed(codes, [](int code, std::size_t) { return code & 0xFF; });
}
HWY_INLINE CodeVec high_bytes(CodeVec codes) {
    return changed(codes, [](int code, std::size_t) { return code >> 8; });
}
HWY_INLINE CodeVec least_of(CodeVec a, CodeVec b) {
    return changed(a, [&](std::uint16_t code, std::size_t i) { return std::min(code, b[i]); });
}
HWY_INLINE CodeVec largest_of(CodeVec a, CodeVec b) {
    return changed(a, [&](std::uint16_t code, std::size_t i) { return std::max(code, b[i]); });
}
HWY_INLINE bool no_values(CodeVec largest) {
    return std::all_of(largest.begin(), largest.end(),
                       [](std::uint16_t code) { return code < grid::first_value_code; });
}
HWY_INLINE bool all_values(CodeVec least) {
    return std::all_of(least.begin(), least.end(),
                       [](std::uint16_t code) { return code >= grid::first_value_code; });
}
HWY_INLINE FloatVec floats_of(CodeVec codes, int part) {
    return hn::Set(Floats(), static_cast<float>(codes[static_cast<std::size_t>(part)]));
}

#else

using Codes = hn::Full128<std::uint16_t>;
using CodeVec = hn::Vec<Codes>;

// Four codes in each number, the first in its low bits.
HWY_INLINE CodeVec codes_of(std::uint64_t first_four, std::uint64_t last_four) {
    const hn::Full64<std::uint64_t> half;
    const hn::Full128<std::uint64_t> whole;
    return hn::BitCast(Codes(),
                       hn::Combine(whole, hn::Set(half, last_four), hn::Set(half, first_four)));
}
HWY_INLINE CodeVec low_bytes(CodeVec codes) {
    return hn::And(codes, hn::Set(Codes(), 0xFF));
}
HWY_INLINE CodeVec high_bytes(CodeVec codes) {
    return hn::ShiftRight<8>(codes);
}
HWY_INLINE CodeVec least_of(CodeVec a, CodeVec b) {
    return hn::Min(a, b);
}
HWY_INLINE CodeVec largest_of(CodeVec a, CodeVec b) {
    return hn::Max(a, b);
}
// Of the largest code at each place; of the least.
HWY_INLINE bool no_values(CodeVec largest) {
    const CodeVec last = hn::Set(Codes(), grid::first_value_code - 1);
    return hn::AllTrue(Codes(), hn::Eq(hn::Min(largest, last), largest));
}
HWY_INLINE bool all_values(CodeVec least) {
    const CodeVec first = hn::Set(Codes(), grid::first_value_code);
    return hn::AllTrue(Codes(), hn::Eq(hn::Max(least, first), least));
}
// One part's rays.
template <class Vec = CodeVec>
HWY_INLINE FloatVec floats_of(Vec codes, int part) {
    const Floats f;
    const Ints i;
    if constexpr (lanes == 8) {
        static_cast<void>(part);
        return hn::ConvertTo(f, hn::PromoteTo(i, codes));
    } else {
        const hn::Half<Codes> four;
        const auto half = part == 0 ? hn::LowerHalf(codes) : hn::UpperHalf(four, codes);
        return hn::ConvertTo(f, hn::PromoteTo(i, half));
    }
}

#endif

}  // namespace stormcellar::render::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
