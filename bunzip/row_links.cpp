#include "bunzip/row_links.h"

#include <algorithm>

#include "bunzip/targets-inl.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bunzip/row_links.cpp"
#include <hwy/foreach_target.h>
// This include must come after foreach_target.h, which compiles this file once for each target.
#include <hwy/highway.h>

#include "bunzip/kernels-inl.h"

#ifndef STORMCELLAR_BUNZIP_ROW_LINKS_ONCE
#define STORMCELLAR_BUNZIP_ROW_LINKS_ONCE
namespace stormcellar::bunzip {

// Returns, for each byte, the first row that begins with it.
inline std::array<std::uint32_t, 256> first_rows(const std::array<std::uint32_t, 256>& count) {
    std::array<std::uint32_t, 256> first{};
    std::uint32_t row = 0;
    for (std::size_t byte = 0; byte < 256; ++byte) {
        first[byte] = row;
        row += count[byte];
    }
    return first;
}

}  // namespace stormcellar::bunzip
#endif

#if HWY_TARGET == HWY_AVX3_DL
HWY_BEFORE_NAMESPACE();
namespace stormcellar::bunzip::HWY_NAMESPACE {

// Returns a mask of the first `count` of 16 lanes, or of all if `count` is larger. bzhi uses only
// the lowest byte of its count, so limit it to 16.
HWY_INLINE __mmask16 first_lanes(std::uint32_t count) {
    return static_cast<__mmask16>(_bzhi_u32(0xFFFF, std::min(count, 16U)));
}

// Links the rows. Runs are short and their lengths cannot be predicted, so a masked store writes up
// to 16 rows at once without a branch.
void link_rows(std::span<const ByteRun> runs, const std::array<std::uint32_t, 256>& count,
               Link* links) {
    std::array<std::uint32_t, 256> next = first_rows(count);
    const __m512i steps = _mm512_slli_epi32(
        _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15), link_shift);
    std::uint32_t row = 0;
    for (const ByteRun run : runs) {
        const std::uint32_t byte = run.byte(), length = run.length();
        Link* const to = links + next[byte];
        next[byte] += length;
        const std::uint32_t link = row << link_shift | byte;
        row += length;
        __m512i values = _mm512_add_epi32(steps, _mm512_set1_epi32(static_cast<int>(link)));
        _mm512_mask_storeu_epi32(to, first_lanes(length), values);
        for (std::uint32_t done = 16; HWY_UNLIKELY(done < length); done += 16) {
            values = _mm512_add_epi32(values, _mm512_set1_epi32(16 << link_shift));
            _mm512_mask_storeu_epi32(to + done, first_lanes(length - done), values);
        }
    }
}

}  // namespace stormcellar::bunzip::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif

#if HWY_ONCE
namespace stormcellar::bunzip {
namespace {

void link_rows_plainly(std::span<const ByteRun> runs, const std::array<std::uint32_t, 256>& count,
                       Link* links) {
    std::array<std::uint32_t, 256> next = first_rows(count);
    std::uint32_t row = 0;
    for (const ByteRun run : runs) {
        Link* const to = links + next[run.byte()];
        next[run.byte()] += run.length();
        Link link = row << link_shift | run.byte();
        row += run.length();
        for (std::uint32_t i = 0; i < run.length(); ++i, link += 1U << link_shift)
            to[i] = link;
    }
}

}  // namespace

LinkRows link_rows_by(Path path) {
    return Kernels<LinkRows>{link_rows_plainly, nullptr, STORMCELLAR_BUNZIP_AVX512(link_rows)}.of(
        path);
}

}  // namespace stormcellar::bunzip
#endif
