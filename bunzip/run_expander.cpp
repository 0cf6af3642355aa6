#include "bunzip/run_expander.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "bunzip/targets-inl.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bunzip/run_expander.cpp"
#include <hwy/foreach_target.h>
// This include must come after foreach_target.h, which compiles this file once for each target.
#include <hwy/highway.h>

#include "bunzip/kernels-inl.h"

#if HWY_TARGET == HWY_AVX2 || HWY_TARGET == HWY_AVX3_DL
HWY_BEFORE_NAMESPACE();
namespace stormcellar::bunzip::HWY_NAMESPACE {

// In a Window, bit i of `equal` is set if byte i equals byte i + 1.
#if HWY_TARGET == HWY_AVX3_DL
constexpr unsigned width = 64;
struct Window {
    explicit HWY_INLINE Window(const std::uint8_t* from) : bytes(_mm512_loadu_si512(from)) {
        equal = _mm512_cmpeq_epi8_mask(bytes, _mm512_loadu_si512(from + 1));
    }
    HWY_INLINE void store(std::uint8_t* to) const { _mm512_storeu_si512(to, bytes); }
    __m512i bytes;
    std::uint64_t equal;
};
HWY_INLINE void fill(std::uint8_t* to, std::uint8_t byte) {
    _mm512_storeu_si512(to, _mm512_set1_epi8(static_cast<char>(byte)));
}
#else
constexpr unsigned width = 32;
struct Window {
    explicit HWY_INLINE Window(const std::uint8_t* from)
        : bytes(_mm256_loadu_si256(reinterpret_cast<const __m256i*>(from))) {
        const __m256i next = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from + 1));
        equal = static_cast<std::uint32_t>(_mm256_movemask_epi8(_mm256_cmpeq_epi8(bytes, next)));
    }
    HWY_INLINE void store(std::uint8_t* to) const {
        _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), bytes);
    }
    __m256i bytes;
    std::uint64_t equal;
};
HWY_INLINE void fill(std::uint8_t* to, std::uint8_t byte) {
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), _mm256_set1_epi8(static_cast<char>(byte)));
}
#endif

// Copies windows of bytes that hold no four equal bytes in a row. At four equal bytes, the function
// writes the run with its repetitions and continues after the count.
RunExpander::Place expand(RunExpander::Place place, const std::uint8_t* end,
                          const std::uint8_t* to_end) {
    // The last two bytes of a window may begin a run that goes on after it, so read them again.
    constexpr unsigned step = width - 2;
    constexpr std::ptrdiff_t most_read = width + 8, most_made = 2 * width + 260;
    auto [from, to] = place;
    while (end - from >= most_read && to_end - to >= most_made) {
        const Window window{from};
        window.store(to);
        const std::uint64_t four = window.equal & window.equal >> 1 & window.equal >> 2;
        if (four == 0) {
            from += step;
            to += step;
            continue;
        }
        const int before = std::countr_zero(four);
        const std::uint8_t byte = from[before];
        const unsigned times = 4U + from[before + 4];
        to += before;
        fill(to, byte);
        for (unsigned done = width; HWY_UNLIKELY(done < times); done += width)
            fill(to + done, byte);
        to += times;
        from += before + 5;
    }
    return {from, to};
}

}  // namespace stormcellar::bunzip::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif

#if HWY_ONCE
namespace stormcellar::bunzip {
namespace {

RunExpander::Place expand_plainly(RunExpander::Place place, const std::uint8_t* end,
                                  const std::uint8_t* to_end) {
    constexpr std::ptrdiff_t most_read = 24, most_made = 16 + 256;
    auto [from, to] = place;
    while (end - from >= most_read && to_end - to >= most_made) {
        std::uint64_t bytes = 0, next = 0;
        std::memcpy(&bytes, from, 8);
        std::memcpy(&next, from + 1, 8);
        std::memcpy(to, &bytes, 8);
        // Two equal neighbors give a zero byte in the difference. Subtracting 1 from each byte
        // finds the first zero byte by its borrow.
        const std::uint64_t difference = bytes ^ next;
        constexpr std::uint64_t low = 0x0101010101010101, high = 0x8080808080808080;
        const std::uint64_t pairs = (difference - low) & ~difference & high;
        if (pairs == 0) {
            from += 8;
            to += 8;
            continue;
        }
        if constexpr (std::endian::native == std::endian::little) {
            from += std::countr_zero(pairs) / 8;
            to += std::countr_zero(pairs) / 8;
        }
        const std::uint8_t byte = from[0];
        if (byte == from[1] && byte == from[2] && byte == from[3]) {
            const unsigned more = from[4];
            std::memset(to, byte, 4 + more);
            to += 4 + more;
            from += 5;
            continue;
        }
        *to++ = *from++;
    }
    return {from, to};
}

RunExpander::Expand expand_by(Path path) {
    return Kernels<RunExpander::Expand>{expand_plainly, STORMCELLAR_BUNZIP_AVX2(expand),
                                        STORMCELLAR_BUNZIP_AVX512(expand)}
        .of(path);
}

}  // namespace

void RunExpander::begin(std::span<const std::uint8_t> bytes_and_one_more, Path path) {
    at_ = bytes_and_one_more.data();
    end_ = at_ + bytes_and_one_more.size() - 1;
    expand_ = expand_by(path);
    fill_left_ = 0;
    equal_ = 0;
}

// Reads byte by byte, for the end of the block or of the room.
void RunExpander::read_careful(std::span<std::uint8_t> out, std::size_t& made) {
    while (made < out.size()) {
        if (fill_left_ > 0) {
            const std::size_t now = std::min<std::size_t>(fill_left_, out.size() - made);
            std::memset(out.data() + made, fill_byte_, now);
            made += now;
            fill_left_ -= static_cast<std::uint32_t>(now);
            continue;
        }
        if (at_ >= end_) return;
        const std::uint8_t byte = *at_++;
        equal_ = equal_ > 0 && byte == fill_byte_ ? equal_ + 1 : 1;
        fill_byte_ = byte;
        out[made++] = byte;
        if (equal_ < 4) continue;
        fill_left_ = *at_++;
        equal_ = 0;
    }
}

std::size_t RunExpander::read(std::span<std::uint8_t> out) {
    std::size_t made = 0;
    if (fill_left_ > 0 || equal_ > 0) {
        // Read up to a place that is not inside a run.
        while (made < out.size() && !ended() && (fill_left_ > 0 || equal_ > 0)) {
            const std::uint8_t* const before = at_;
            const unsigned equal_before = equal_;
            read_careful(out.first(made + 1), made);
            if (at_ != before && equal_ == 1 && equal_before > 0) {
                // This byte differs from the byte before it, so read it again as the first byte of
                // a run.
                --at_;
                --made;
                equal_ = 0;
            }
        }
    }
    if (fill_left_ == 0 && equal_ == 0 && at_ < end_) {
        const Place place = expand_({at_, out.data() + made}, end_, out.data() + out.size());
        at_ = place.from;
        made = static_cast<std::size_t>(place.to - out.data());
    }
    read_careful(out, made);
    return made;
}

}  // namespace stormcellar::bunzip
#endif
