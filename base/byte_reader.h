// base/byte_reader.h -- reads big-endian numbers from untrusted bytes.
//
// A read past the end returns zero and sets failed(), after which all reads return zero. So a
// caller may read a whole structure and check once. Nothing is ever read outside the span.
//
// Threads   A reader is a plain value; do not share one between threads.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace stormcellar {

class ByteReader {
  public:
    explicit ByteReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

    [[nodiscard]] std::size_t position() const { return position_; }
    [[nodiscard]] std::size_t remaining() const { return bytes_.size() - position_; }
    [[nodiscard]] bool failed() const { return failed_; }

    std::uint8_t u8() { return static_cast<std::uint8_t>(unsigned_number(1)); }
    std::uint16_t u16() { return static_cast<std::uint16_t>(unsigned_number(2)); }
    std::uint32_t u32() { return static_cast<std::uint32_t>(unsigned_number(4)); }
    std::int16_t i16() { return static_cast<std::int16_t>(u16()); }
    std::int32_t i32() { return static_cast<std::int32_t>(u32()); }
    float f32() { return std::bit_cast<float>(u32()); }

    // Returns the next n bytes, or an empty span (and sets failed()) if fewer are left.
    std::span<const std::byte> bytes(std::size_t n) {
        if (failed_ || n > remaining()) {
            failed_ = true;
            return {};
        }
        const auto part = bytes_.subspan(position_, n);
        position_ += n;
        return part;
    }

    std::string_view text(std::size_t n) {
        const auto part = bytes(n);
        return {reinterpret_cast<const char*>(part.data()), part.size()};
    }

    void skip(std::size_t n) { bytes(n); }

    void seek(std::size_t position) {
        if (position > bytes_.size()) {
            failed_ = true;
        } else {
            position_ = position;
        }
    }

  private:
    std::uint32_t unsigned_number(std::size_t width) {
        std::uint32_t number = 0;
        for (const std::byte b : bytes(width)) {
            number = (number << 8) | std::to_integer<std::uint32_t>(b);
        }
        return number;
    }

    std::span<const std::byte> bytes_;
    std::size_t position_ = 0;
    bool failed_ = false;
};

}  // namespace stormcellar
