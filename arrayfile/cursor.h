// arrayfile/cursor.h -- reads little-endian numbers of any width from untrusted bytes.
//
// A read past the end returns zero and sets failed(). After that, all reads return zero, as in
// base/byte_reader.h.
//
// Threads   A cursor is a plain value; do not share one between threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace stormcellar::arrayfile {

class Cursor {
  public:
    Cursor() = default;
    explicit Cursor(std::span<const std::byte> bytes) : bytes_(bytes) {}

    [[nodiscard]] bool failed() const { return failed_; }
    [[nodiscard]] std::size_t remaining() const { return bytes_.size() - position_; }
    [[nodiscard]] std::size_t position() const { return position_; }

    std::span<const std::byte> bytes(std::uint64_t count) {
        if (failed_ || count > remaining()) {
            failed_ = true;
            return {};
        }
        const auto part = bytes_.subspan(position_, static_cast<std::size_t>(count));
        position_ += part.size();
        return part;
    }
    void skip(std::uint64_t count) { bytes(count); }
    // Skips bytes up to a multiple of eight from the start.
    void align() { skip((8 - position_ % 8) % 8); }

    // Reads a number of up to eight bytes.
    std::uint64_t number(std::size_t width) {
        const auto part = bytes(width);
        std::uint64_t value = 0;
        for (std::size_t i = part.size(); i-- > 0;)
            value = (value << 8) | std::to_integer<std::uint64_t>(part[i]);
        return value;
    }
    std::uint8_t u8() { return static_cast<std::uint8_t>(number(1)); }
    std::uint16_t u16() { return static_cast<std::uint16_t>(number(2)); }
    std::uint32_t u32() { return static_cast<std::uint32_t>(number(4)); }

    std::string_view text(std::uint64_t count) {
        const auto part = bytes(count);
        return {reinterpret_cast<const char*>(part.data()), part.size()};
    }
    // Returns true if the next bytes are these letters, and skips them.
    bool takes(std::string_view letters) { return text(letters.size()) == letters; }

  private:
    std::span<const std::byte> bytes_;
    std::size_t position_ = 0;
    bool failed_ = false;
};

// Returns the text before the first zero.
inline std::string before_zero(std::string_view text) {
    return std::string{text.substr(0, text.find('\0'))};
}

}  // namespace stormcellar::arrayfile
