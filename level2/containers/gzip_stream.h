// level2/containers/gzip_stream.h -- inflates all members of a gzip file with zlib, piece by piece.
//
// next() returns the bytes before any damage; end() then reports the damage.
//
// Threads   One thread at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <zlib.h>

namespace stormcellar::level2 {

[[nodiscard]] bool is_gzip(std::span<const std::byte> bytes);

enum class GzipEnd : std::uint8_t {
    none,             // the end is not reached
    whole,            // all members were read, with right checksums
    truncated,        // the file ends inside a member
    corrupt,          // the compressed data are invalid
    bad_checksum,     // a member was read, but its length or CRC-32 differs
    trailing_garbage  // something other than gzip follows the last member
};

class GzipStream {
  public:
    static constexpr std::size_t piece_bytes = std::size_t{256} << 10;

    explicit GzipStream(std::span<const std::byte> bytes);
    GzipStream(const GzipStream&) = delete;
    GzipStream& operator=(const GzipStream&) = delete;
    ~GzipStream();

    // Returns the next bytes, which are valid until the next call, or an empty span at the end.
    [[nodiscard]] std::span<const std::byte> next();
    [[nodiscard]] GzipEnd end() const { return end_; }
    // Returns how many compressed bytes were read.
    [[nodiscard]] std::size_t position() const { return fed_ - stream_.avail_in; }

  private:
    // Begins the next member. Returns false, and sets the end, if no member follows.
    [[nodiscard]] bool next_member();
    [[nodiscard]] GzipEnd end_of(int code) const;

    std::span<const std::byte> bytes_;
    std::vector<std::byte> output_;
    z_stream stream_{};
    std::size_t fed_ = 0;
    GzipEnd end_ = GzipEnd::none;
};

// Returns the inflated bytes of a gzip file, up to any damage, or a copy of other bytes. Use it for
// trusted files only, because nothing bounds the length.
[[nodiscard]] std::vector<std::byte> without_gzip(std::span<const std::byte> bytes);

}  // namespace stormcellar::level2
