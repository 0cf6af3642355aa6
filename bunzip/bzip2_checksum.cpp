#include "bunzip/bzip2_checksum.h"

#include <array>
#include <bit>
#include <cstring>

#include "bunzip/targets-inl.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bunzip/bzip2_checksum.cpp"
#include <hwy/foreach_target.h>
// This include must come after foreach_target.h, which compiles this file once for each target.
#include <hwy/highway.h>

#include "bunzip/kernels-inl.h"

#ifndef STORMCELLAR_BUNZIP_CHECKSUM_ONCE
#define STORMCELLAR_BUNZIP_CHECKSUM_ONCE
namespace stormcellar::bunzip {

constexpr std::uint32_t polynomial = 0x04C11DB7;

constexpr std::uint32_t times_x(std::uint32_t remainder) {
    return remainder << 1 ^ (remainder >> 31 != 0 ? polynomial : 0);
}
// Returns x to the power of `exponent`, modulo the polynomial.
constexpr std::uint32_t power_of_x(unsigned exponent) {
    std::uint32_t remainder = 1;
    for (unsigned i = 0; i < exponent; ++i)
        remainder = times_x(remainder);
    return remainder;
}

// Makes tables in which tables[k][b] is the change to the state by a byte b with k more bytes after
// it.
constexpr auto make_tables() {
    std::array<std::array<std::uint32_t, 256>, 16> tables{};
    for (std::uint32_t byte = 0; byte < 256; ++byte) {
        std::uint32_t state = byte << 24;
        for (auto& table : tables) {
            for (int bit = 0; bit < 8; ++bit)
                state = times_x(state);
            table[byte] = state;
        }
    }
    return tables;
}
inline constexpr auto tables = make_tables();

inline std::uint32_t checksum_plainly(std::uint32_t state, std::span<const std::uint8_t> bytes) {
    std::size_t i = 0;
    for (; i + 16 <= bytes.size(); i += 16) {
        const std::uint8_t* const at = bytes.data() + i;
        std::uint32_t next = 0;
        for (unsigned k = 0; k < 4; ++k)
            next ^= tables[15 - k][at[k] ^ (state >> (24 - 8 * k) & 0xFF)];
        for (unsigned k = 4; k < 16; ++k)
            next ^= tables[15 - k][at[k]];
        state = next;
    }
    for (; i < bytes.size(); ++i)
        state = state << 8 ^ tables[0][(state >> 24) ^ bytes[i]];
    return state;
}

}  // namespace stormcellar::bunzip
#endif

#if HWY_TARGET == HWY_AVX2 || HWY_TARGET == HWY_AVX3_DL
HWY_BEFORE_NAMESPACE();
namespace stormcellar::bunzip::HWY_NAMESPACE {

HWY_INLINE __m128i load_reversed(const std::uint8_t* from) {
    const __m128i order = _mm_setr_epi8(15, 14, 13, 12, 11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0);
    return _mm_shuffle_epi8(_mm_loadu_si128(reinterpret_cast<const __m128i*>(from)), order);
}

// Multiplies a remainder of 128 bits by x^distance, modulo the polynomial. `powers` holds
// x^(distance + 64) for its high half and x^distance for its low half. The products have at most 96
// bits, so they fit.
HWY_INLINE __m128i fold(__m128i sum, __m128i powers) {
    return _mm_xor_si128(_mm_clmulepi64_si128(sum, powers, 0x11),
                         _mm_clmulepi64_si128(sum, powers, 0x00));
}
template <unsigned Distance>
HWY_INLINE __m128i powers_of() {
    constexpr std::uint32_t high = power_of_x(Distance + 64), low = power_of_x(Distance);
    return _mm_set_epi64x(high, low);
}

// Computes the checksum of long input with carry-less multiplications. Four sums of 16 bytes
// alternate, so that no multiplication waits for the previous multiplication. At the end, the four
// sums are folded into one.
std::uint32_t checksum(std::uint32_t state, std::span<const std::uint8_t> bytes) {
    constexpr std::size_t step = 64;
    if (bytes.size() < 2 * step) return checksum_plainly(state, bytes);
    const std::uint8_t* at = bytes.data();
    __m128i sums[4];
    for (int k = 0; k < 4; ++k)
        sums[k] = load_reversed(at + 16 * k);
    sums[0] = _mm_xor_si128(sums[0], _mm_set_epi32(static_cast<int>(state), 0, 0, 0));
    std::size_t left = bytes.size() - step;
    const __m128i far = powers_of<8 * step>();
    for (at += step; left >= step; at += step, left -= step) {
        for (int k = 0; k < 4; ++k)
            sums[k] = _mm_xor_si128(fold(sums[k], far), load_reversed(at + 16 * k));
    }
    const __m128i near = powers_of<128>();
    __m128i sum = sums[0];
    for (int k = 1; k < 4; ++k)
        sum = _mm_xor_si128(fold(sum, near), sums[k]);
    // The sum is a message of 16 bytes that has the same remainder as all folded bytes.
    std::uint8_t message[16];
    const __m128i order = _mm_setr_epi8(15, 14, 13, 12, 11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0);
    _mm_storeu_si128(reinterpret_cast<__m128i*>(message), _mm_shuffle_epi8(sum, order));
    return checksum_plainly(checksum_plainly(0, message), {at, left});
}

}  // namespace stormcellar::bunzip::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif

#if HWY_ONCE
namespace stormcellar::bunzip {

Checksum checksum_by(Path path) {
    return Kernels<Checksum>{checksum_plainly, STORMCELLAR_BUNZIP_AVX2(checksum),
                             STORMCELLAR_BUNZIP_AVX512(checksum)}
        .of(path);
}

}  // namespace stormcellar::bunzip
#endif
