// bunzip/bit_reader.h -- reads the bits of a span, the highest bit of a byte first.
//
// A BitReader never reads outside the span.
//
// Threads   One thread at a time.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>

namespace stormcellar::bunzip {

// Loads eight bytes as a number, the first byte highest.
[[nodiscard]] inline std::uint64_t load_big_endian(const std::byte* from) {
    std::uint64_t raw = 0;
    std::memcpy(&raw, from, sizeof raw);
    if constexpr (std::endian::native == std::endian::little) raw = __builtin_bswap64(raw);
    return raw;
}

class BitReader {
  public:
    explicit BitReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

    [[nodiscard]] std::uint64_t position() const { return bit_; }
    [[nodiscard]] std::uint64_t bits_left() const {
        return std::uint64_t{bytes_.size()} * 8 - bit_;
    }
    // Returns the number of bytes from which bits were taken.
    [[nodiscard]] std::size_t bytes_taken() const {
        return static_cast<std::size_t>((bit_ + 7) / 8);
    }
    [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }

    // Returns at least the next 57 bits, the first bit highest, with zeros beyond the end.
    [[nodiscard]] std::uint64_t peek() const {
        const auto at = static_cast<std::size_t>(bit_ / 8);
        const std::size_t left = bytes_.size() - at;
        if (left >= 8) return load_big_endian(bytes_.data() + at) << (bit_ % 8);
        std::byte last[8] = {};
        if (left > 0) std::memcpy(last, bytes_.data() + at, left);
        return load_big_endian(last) << (bit_ % 8);
    }
    // Skips bits, at most bits_left() of them.
    void skip(std::uint64_t bits) { bit_ += bits; }
    void move_to(std::uint64_t position) { bit_ = position; }

    // Reads 1 to 32 bits. Returns none, and takes no bits, if there are not enough.
    [[nodiscard]] std::optional<std::uint32_t> read(unsigned bits) {
        if (bits_left() < bits) return std::nullopt;
        const auto value = static_cast<std::uint32_t>(peek() >> (64 - bits));
        bit_ += bits;
        return value;
    }

  private:
    std::span<const std::byte> bytes_;
    std::uint64_t bit_ = 0;
};

}  // namespace stormcellar::bunzip
