// level2/containers/compress_stream.h -- expands Unix compress (.Z), as in archives of the 1990s,
// piece by piece.
//
// next() returns the bytes before any damage; end() then reports the damage.
//
// Format    3 bytes: 1F 9D, then the largest code width, 9 to 16, plus 0x80 if code 256 clears the
//           table. After them come codes, low bits first, beginning with codes of 9 bits. Codes of
//           one width come in groups of eight; where the width changes or the table is cleared, the
//           rest of the group is padding. The format has no checksum and no length, so a cut
//           between two codes cannot be detected.
// Source    Welch, IEEE Computer 17(6) 1984, for the algorithm; the behavior of compress 4.0 for
//           the grouping, which no document describes.
// Memory    256 KiB of tables, and one piece.
// Threads   One thread at a time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace stormcellar::level2 {

[[nodiscard]] bool is_compress(std::span<const std::byte> bytes);

enum class CompressEnd : std::uint8_t {
    none,       // the end is not reached
    whole,      // all codes were read; a cut between two codes is not detected
    truncated,  // shorter than its header
    corrupt     // an impossible code
};

class CompressStream {
  public:
    static constexpr std::size_t piece_bytes = std::size_t{256} << 10;

    explicit CompressStream(std::span<const std::byte> bytes);

    // Returns the next bytes, which are valid until the next call, or an empty span at the end.
    [[nodiscard]] std::span<const std::byte> next();
    [[nodiscard]] CompressEnd end() const { return end_; }
    // Returns how many compressed bytes were read.
    [[nodiscard]] std::size_t position() const;

  private:
    static constexpr int least_width = 9;
    static constexpr int most_width = 16;

    [[nodiscard]] std::optional<std::uint32_t> next_code();
    // Skips the rest of the group of eight codes, and begins a group of codes of this width.
    void begin_group(int width);
    void take(std::uint32_t code);
    void enter(std::uint32_t prefix, std::byte last);
    // Appends the string of a code to the output, and returns its first byte.
    std::byte expand(std::uint32_t code);

    std::span<const std::byte> bytes_;
    std::uint64_t bit_ = 0;          // position of the next code
    std::uint64_t group_start_ = 0;  // the bit at which the codes of this width began
    int width_ = least_width;
    int limit_ = least_width;  // the largest width
    bool clears_ = false;
    std::uint32_t next_entry_ = 256;
    std::optional<std::uint32_t> previous_;
    std::byte first_of_previous_{};
    std::vector<std::uint16_t> prefixes_;
    std::vector<std::byte> lasts_;
    std::vector<std::byte> output_;
    CompressEnd end_ = CompressEnd::none;
};

}  // namespace stormcellar::level2
