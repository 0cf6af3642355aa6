#include "bunzip/byte_runs.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "bunzip/targets-inl.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bunzip/byte_runs.cpp"
#include <hwy/foreach_target.h>
// This include must come after foreach_target.h, which compiles this file once for each target.
#include <hwy/highway.h>

#include "bunzip/kernels-inl.h"

#ifndef STORMCELLAR_BUNZIP_BYTE_RUNS_ONCE
#define STORMCELLAR_BUNZIP_BYTE_RUNS_ONCE
namespace stormcellar::bunzip {

// A number of bytes larger than any block. The caller then finds that the block is bad.
constexpr std::uint64_t too_many_bytes = std::uint64_t{1} << 62;

// Makes a table of permutations. Row k moves the byte at place k to the front, and each byte before
// it back by one place.
template <std::size_t Size>
constexpr auto make_patterns() {
    std::array<std::array<std::uint8_t, Size>, Size> patterns{};
    for (std::size_t k = 0; k < Size; ++k) {
        for (std::size_t i = 0; i < Size; ++i)
            patterns[k][i] = static_cast<std::uint8_t>(i == 0 ? k : i <= k ? i - 1 : i);
    }
    return patterns;
}

inline void end_run(RunMaker& maker, std::uint8_t byte, std::uint32_t length, ByteRun*& to) {
    *to++ = ByteRun{byte, length};
    maker.bytes += length;
    maker.count[byte] += length;
}

inline std::uint32_t run_length(const RunMaker& maker) {
    return maker.times + ((1U << maker.digits) - 1) + maker.digit_bits;
}

}  // namespace stormcellar::bunzip
#endif

#if HWY_TARGET == HWY_AVX2 || HWY_TARGET == HWY_AVX3_DL
HWY_BEFORE_NAMESPACE();
namespace stormcellar::bunzip::HWY_NAMESPACE {

#if HWY_TARGET == HWY_AVX3_DL

// The list of 256 bytes in four registers of 64. A move within the first 64 places, the usual case,
// is one permutation of the first register.
class FrontList {
  public:
    explicit HWY_INLINE FrontList(const std::uint8_t* list) {
        for (int i = 0; i < 4; ++i)
            part_[i] = _mm512_loadu_si512(list + i * 64);
    }
    HWY_INLINE void store(std::uint8_t* list) const {
        for (int i = 0; i < 4; ++i)
            _mm512_storeu_si512(list + i * 64, part_[i]);
    }
    [[nodiscard]] HWY_INLINE std::uint8_t front() const { return first_of(part_[0]); }
    HWY_INLINE void move(std::uint32_t place) {
        if (HWY_UNLIKELY(place >= 64)) {
            move_far(place);
        } else {
            part_[0] = to_front(part_[0], place);
        }
    }

  private:
    static constexpr auto patterns = make_patterns<64>();
    static HWY_INLINE __m512i to_front(__m512i part, std::uint32_t place) {
        return _mm512_permutexvar_epi8(_mm512_loadu_si512(patterns[place].data()), part);
    }
    static HWY_INLINE std::uint8_t first_of(__m512i part) {
        return static_cast<std::uint8_t>(_mm_cvtsi128_si32(_mm512_castsi512_si128(part)));
    }
    // For a move from farther back, first rotate each register before the register with the moved
    // byte, so that the last byte of each comes to the front. Then put this byte at the front of
    // the next register, and the moved byte at the front of the first register.
    HWY_INLINE void move_far(std::uint32_t place) {
        const __mmask64 first = 1;
        const __m512i front = to_front(part_[0], 63);
        __m512i carried = front;
        if (place < 128) {
            const __m512i found = to_front(part_[1], place - 64);
            part_[1] = _mm512_mask_blend_epi8(first, found, carried);
            carried = found;
        } else {
            const __m512i second = to_front(part_[1], 63);
            part_[1] = _mm512_mask_blend_epi8(first, second, carried);
            if (place < 192) {
                const __m512i found = to_front(part_[2], place - 128);
                part_[2] = _mm512_mask_blend_epi8(first, found, second);
                carried = found;
            } else {
                const __m512i third = to_front(part_[2], 63);
                part_[2] = _mm512_mask_blend_epi8(first, third, second);
                const __m512i found = to_front(part_[3], place - 192);
                part_[3] = _mm512_mask_blend_epi8(first, found, third);
                carried = found;
            }
        }
        part_[0] = _mm512_mask_blend_epi8(first, front, carried);
    }
    __m512i part_[4];
};

// Masks over 64 symbols: bits of the moves, and bits of the symbol 1 (run_b).
struct SymbolMasks {
    std::uint64_t moves, ones;
};
HWY_INLINE SymbolMasks masks_of(const std::uint16_t* symbols) {
    SymbolMasks masks{0, 0};
    const __m512i one = _mm512_set1_epi16(run_b);
    for (int i = 0; i < 2; ++i) {
        const __m512i part = _mm512_loadu_si512(symbols + i * 32);
        masks.moves |= std::uint64_t{_mm512_cmpgt_epu16_mask(part, one)} << (i * 32);
        masks.ones |= std::uint64_t{_mm512_cmpeq_epu16_mask(part, one)} << (i * 32);
    }
    return masks;
}

#else

// The list of 256 bytes: the first 16 are in a register, the others in memory. A move within the
// first 16 places is one shuffle.
class FrontList {
  public:
    explicit HWY_INLINE FrontList(const std::uint8_t* list)
        : front_(_mm_loadu_si128(reinterpret_cast<const __m128i*>(list))) {
        std::memcpy(rest_ + slack, list + held, 256 - held);
    }
    HWY_INLINE void store(std::uint8_t* list) const {
        _mm_storeu_si128(reinterpret_cast<__m128i*>(list), front_);
        std::memcpy(list + held, rest_ + slack, 256 - held);
    }
    [[nodiscard]] HWY_INLINE std::uint8_t front() const {
        return static_cast<std::uint8_t>(_mm_cvtsi128_si32(front_));
    }
    HWY_INLINE void move(std::uint32_t place) {
        if (HWY_UNLIKELY(place >= held)) {
            move_far(place - held);
        } else {
            front_ = _mm_shuffle_epi8(front_, pattern(place));
        }
    }

  private:
    static constexpr std::uint32_t held = 16, slack = 32;
    static constexpr auto patterns = make_patterns<held>();
    static HWY_INLINE __m128i pattern(std::uint32_t place) {
        return _mm_loadu_si128(reinterpret_cast<const __m128i*>(patterns[place].data()));
    }
    // Moves the bytes before the moved byte back by one place, in pieces of 32 from the end. The
    // last piece also reads bytes of the slack.
    HWY_INLINE void move_far(std::uint32_t place) {
        std::uint8_t* const rest = rest_ + slack;
        const std::uint8_t found = rest[place];
        for (int at = static_cast<int>(place); at > 0; at -= 32) {
            const __m256i piece =
                _mm256_loadu_si256(reinterpret_cast<const __m256i*>(rest + at - 32));
            _mm256_storeu_si256(reinterpret_cast<__m256i*>(rest + at - 31), piece);
        }
        const __m128i turned = _mm_shuffle_epi8(front_, pattern(held - 1));
        rest[0] = static_cast<std::uint8_t>(_mm_cvtsi128_si32(turned));
        front_ = _mm_insert_epi8(turned, found, 0);
    }
    __m128i front_;
    std::uint8_t rest_[slack + 256 - held] = {};
};

struct SymbolMasks {
    std::uint64_t moves, ones;
};
HWY_INLINE std::uint32_t mask_of(__m256i low, __m256i high) {
    const __m256i packed = _mm256_permute4x64_epi64(_mm256_packs_epi16(low, high), 0xD8);
    return static_cast<std::uint32_t>(_mm256_movemask_epi8(packed));
}
HWY_INLINE SymbolMasks masks_of(const std::uint16_t* symbols) {
    SymbolMasks masks{0, 0};
    const __m256i one = _mm256_set1_epi16(run_b);
    for (int i = 0; i < 2; ++i) {
        const auto* const from = reinterpret_cast<const __m256i*>(symbols + i * 32);
        const __m256i low = _mm256_loadu_si256(from), high = _mm256_loadu_si256(from + 1);
        masks.moves |=
            std::uint64_t{mask_of(_mm256_cmpgt_epi16(low, one), _mm256_cmpgt_epi16(high, one))}
            << (i * 32);
        masks.ones |=
            std::uint64_t{mask_of(_mm256_cmpeq_epi16(low, one), _mm256_cmpeq_epi16(high, one))}
            << (i * 32);
    }
    return masks;
}

#endif

// Makes runs from 64 symbols, or fewer at the end. Returns false if a run has too many digits. The
// loop visits only the moves, along the bits of a mask. The symbols between two moves are digits,
// and their mask gives the length of the run at once. A branch on each symbol would be slow,
// because it cannot be predicted.
HWY_INLINE bool take_symbols(RunMaker& maker, FrontList& list, const std::uint16_t* symbols,
                             unsigned there, ByteRun*& to) {
    SymbolMasks masks = masks_of(symbols);
    const std::uint64_t valid = ~std::uint64_t{0} >> (64 - there);
    std::uint64_t moves = masks.moves & valid;
    const std::uint64_t ones = masks.ones & valid;
    // If there is no move, all symbols are digits of the run that continues.
    if (moves == 0) {
        maker.digit_bits |= static_cast<std::uint32_t>(ones << std::min(maker.digits, 32U));
        maker.digits += there;
        return maker.digits <= most_run_digits;
    }
    // The first move ends a run that may have begun in earlier symbols.
    auto at = static_cast<unsigned>(std::countr_zero(moves));
    const std::uint64_t before = ones & ((std::uint64_t{1} << at) - 1);
    maker.digit_bits |= static_cast<std::uint32_t>(before << maker.digits);
    maker.digits += at;
    if (maker.digits > most_run_digits) return false;
    end_run(maker, list.front(), run_length(maker), to);
    maker.times = 1;
    list.move(symbols[at] - 1U);
    std::uint64_t bytes = 0;
    // Each further move ends a run whose symbols are all among these 64.
    for (moves &= moves - 1; moves != 0; moves &= moves - 1) {
        const auto next = static_cast<unsigned>(std::countr_zero(moves));
        const unsigned digits = next - at - 1;
        if (HWY_UNLIKELY(digits > most_run_digits)) return false;
        const std::uint32_t unit = 1U << digits;
        const std::uint32_t length =
            unit + (static_cast<std::uint32_t>(ones >> at >> 1U) & (unit - 1));
        const std::uint8_t byte = list.front();
        *to++ = ByteRun{byte, length};
        maker.count[byte] += length;
        bytes += length;
        list.move(symbols[next] - 1U);
        at = next;
    }
    // The digits after the last move belong to a run that continues.
    maker.bytes += bytes;
    maker.digits = there - at - 1;
    maker.digit_bits = static_cast<std::uint32_t>(ones >> at >> 1U);
    return maker.digits <= most_run_digits;
}

std::size_t make_runs(RunMaker& kept, std::span<const std::uint16_t> symbols, ByteRun* to) {
    const ByteRun* const begin = to;
    FrontList list{kept.list.data()};
    std::size_t i = 0;
    bool good = true;
    for (; good && i + 64 <= symbols.size(); i += 64)
        good = take_symbols(kept, list, symbols.data() + i, 64, to);
    if (good && i < symbols.size()) {
        std::uint16_t last[64] = {};
        std::copy(symbols.begin() + static_cast<std::ptrdiff_t>(i), symbols.end(), last);
        good = take_symbols(kept, list, last, static_cast<unsigned>(symbols.size() - i), to);
    }
    if (!good) kept.bytes = too_many_bytes;
    list.store(kept.list.data());
    return static_cast<std::size_t>(to - begin);
}

}  // namespace stormcellar::bunzip::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif

#if HWY_ONCE
namespace stormcellar::bunzip {
namespace {

// The list of 256 bytes: the first eight are in a number, the others in memory.
class PlainList {
  public:
    explicit PlainList(std::uint8_t* list) : list_(list) {
        for (unsigned i = 0; i < held; ++i)
            front_ |= std::uint64_t{list[i]} << (8 * i);
    }
    void store() const {
        for (unsigned i = 0; i < held; ++i)
            list_[i] = static_cast<std::uint8_t>(front_ >> (8 * i));
    }
    [[nodiscard]] std::uint8_t front() const { return static_cast<std::uint8_t>(front_); }
    void move(std::uint32_t place) {
        if (place < held) {
            const unsigned shift = 8 * place;
            const std::uint64_t above = ~std::uint64_t{0xFF} << shift;
            const std::uint64_t below = (std::uint64_t{1} << shift) - 1;
            front_ = (front_ & above) | (front_ & below) << 8 | (front_ >> shift & 0xFF);
            return;
        }
        const std::uint8_t found = list_[place];
        std::memmove(list_ + held + 1, list_ + held, place - held);
        list_[held] = static_cast<std::uint8_t>(front_ >> 56);
        front_ = front_ << 8 | found;
    }

  private:
    static constexpr unsigned held = 8;
    std::uint8_t* list_;
    std::uint64_t front_ = 0;
};

// Makes runs on any machine, symbol by symbol.
std::size_t make_runs_plainly(RunMaker& maker, std::span<const std::uint16_t> symbols,
                              ByteRun* to) {
    const ByteRun* const begin = to;
    PlainList list{maker.list.data()};
    for (const std::uint16_t symbol : symbols) {
        if (symbol <= run_b) {
            if (maker.digits == most_run_digits) {
                maker.bytes = too_many_bytes;
                break;
            }
            maker.digit_bits |= std::uint32_t{symbol} << maker.digits++;
            continue;
        }
        end_run(maker, list.front(), run_length(maker), to);
        maker.times = 1;
        maker.digits = maker.digit_bits = 0;
        list.move(symbol - 1U);
    }
    list.store();
    return static_cast<std::size_t>(to - begin);
}

}  // namespace

void RunMaker::begin(std::span<const std::uint8_t> bytes_there) {
    std::copy(bytes_there.begin(), bytes_there.end(), list.begin());
    digits = digit_bits = times = 0;
    bytes = 0;
    count.fill(0);
}

ByteRun last_run(RunMaker& maker) {
    ByteRun run;
    ByteRun* to = &run;
    end_run(maker, maker.list[0], run_length(maker), to);
    return run;
}

MakeRuns make_runs_by(Path path) {
    return Kernels<MakeRuns>{make_runs_plainly, STORMCELLAR_BUNZIP_AVX2(make_runs),
                             STORMCELLAR_BUNZIP_AVX512(make_runs)}
        .of(path);
}

}  // namespace stormcellar::bunzip
#endif
