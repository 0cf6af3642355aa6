// level2/messages/byte_writer.h -- appends big-endian numbers to bytes, as the counterpart of
// ByteReader.
//
// Threads   A writer is a plain value; do not share one between threads.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace stormcellar::level2 {

class ByteWriter {
  public:
    [[nodiscard]] std::size_t size() const { return bytes_.size(); }
    [[nodiscard]] std::span<const std::byte> bytes() const { return bytes_; }
    [[nodiscard]] std::vector<std::byte> take() { return std::move(bytes_); }

    void u8(std::uint8_t number) { unsigned_number(number, 1); }
    void u16(std::uint16_t number) { unsigned_number(number, 2); }
    void u32(std::uint32_t number) { unsigned_number(number, 4); }
    void i16(std::int16_t number) { u16(static_cast<std::uint16_t>(number)); }
    void f32(float number) { u32(std::bit_cast<std::uint32_t>(number)); }
    void raw(std::span<const std::uint8_t> codes) {
        const auto part = std::as_bytes(codes);
        bytes_.insert(bytes_.end(), part.begin(), part.end());
    }
    void raw(std::span<const std::byte> part) {
        bytes_.insert(bytes_.end(), part.begin(), part.end());
    }
    // Writes exactly `width` bytes: the text, cut or filled with NULs.
    void text(std::string_view text, std::size_t width) {
        const auto part = std::as_bytes(std::span(text.substr(0, width)));
        raw(part);
        zeros(width - part.size());
    }
    void zeros(std::size_t count) { bytes_.resize(bytes_.size() + count); }
    void pad_to_multiple_of(std::size_t size) { zeros((size - bytes_.size() % size) % size); }

    // Overwrites a number that was written as zero before its value was known.
    void set_u16(std::size_t position, std::uint16_t number) {
        bytes_[position] = static_cast<std::byte>(number >> 8);
        bytes_[position + 1] = static_cast<std::byte>(number & 0xFFU);
    }
    void set_u32(std::size_t position, std::uint32_t number) {
        set_u16(position, static_cast<std::uint16_t>(number >> 16));
        set_u16(position + 2, static_cast<std::uint16_t>(number & 0xFFFFU));
    }

  private:
    void unsigned_number(std::uint32_t number, int width) {
        for (int shift = 8 * (width - 1); shift >= 0; shift -= 8) {
            bytes_.push_back(static_cast<std::byte>((number >> shift) & 0xFFU));
        }
    }

    std::vector<std::byte> bytes_;
};

}  // namespace stormcellar::level2
