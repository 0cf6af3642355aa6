// level2/containers/gzip_stream.h -- inflates gzip with zlib, piece by piece, with one member after
// the other.
//
// Bytes inflated before the damage are returned. Damage is a state at the end and never lost.
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
    none,             // not at the end yet
    whole,            // all members, with right checksums
    truncated,        // the file ends inside a member
    corrupt,          // the data contradict themselves
    bad_checksum,     // everything is there, but length or CRC-32 differ
    trailing_garbage  // something other than gzip follows the last member
};

class GzipStream {
  public:
    static constexpr std::size_t piece_bytes = std::size_t{256} << 10;

    explicit GzipStream(std::span<const std::byte> bytes);
    GzipStream(const GzipStream&) = delete;
    GzipStream& operator=(const GzipStream&) = delete;
    ~GzipStream();

    // Returns the next bytes, which are valid until the next call; empty at the end.
    [[nodiscard]] std::span<const std::byte> next();
    [[nodiscard]] GzipEnd end() const { return end_; }
    // Returns how many compressed bytes were read.
    [[nodiscard]] std::size_t position() const { return fed_ - stream_.avail_in; }

  private:
    // Returns true if another member begins after the one that ended.
    [[nodiscard]] bool next_member();
    [[nodiscard]] GzipEnd end_of(int code) const;

    std::span<const std::byte> bytes_;
    std::vector<std::byte> output_;
    z_stream stream_{};
    std::size_t fed_ = 0;
    GzipEnd end_ = GzipEnd::none;
};

// Returns the bytes without their gzip layer, as far as it can be read; without such a layer, a
// copy. For trusted files only, because the length is not bounded.
[[nodiscard]] std::vector<std::byte> without_gzip(std::span<const std::byte> bytes);

}  // namespace stormcellar::level2
