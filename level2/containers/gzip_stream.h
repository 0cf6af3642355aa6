// level2/containers/gzip_stream.h -- gzip through zlib, piece by piece, members one behind the
// other.
//
// What was inflated before damage is given out; damage is a state at the end, never lost.
// Thread contract: one thread.
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
    whole,            // all members, checksums right
    truncated,        // the file ends inside a member
    corrupt,          // the data contradict themselves
    bad_checksum,     // all there, but length or CRC-32 differ
    trailing_garbage  // something that is not gzip behind the last member
};

class GzipStream {
  public:
    static constexpr std::size_t piece_bytes = std::size_t{256} << 10;

    explicit GzipStream(std::span<const std::byte> bytes);
    GzipStream(const GzipStream&) = delete;
    GzipStream& operator=(const GzipStream&) = delete;
    ~GzipStream();

    // The next bytes, valid until the next call; empty at the end.
    [[nodiscard]] std::span<const std::byte> next();
    [[nodiscard]] GzipEnd end() const { return end_; }
    // How far into the compressed bytes.
    [[nodiscard]] std::size_t position() const { return fed_ - stream_.avail_in; }

  private:
    // Whether another member begins behind the one that ended.
    [[nodiscard]] bool next_member();
    [[nodiscard]] GzipEnd end_of(int code) const;

    std::span<const std::byte> bytes_;
    std::vector<std::byte> output_;
    z_stream stream_{};
    std::size_t fed_ = 0;
    GzipEnd end_ = GzipEnd::none;
};

// The bytes without their gzip layer, as far as it can be read; without such a layer a copy. For
// files that are trusted: the length is not bounded.
[[nodiscard]] std::vector<std::byte> without_gzip(std::span<const std::byte> bytes);

}  // namespace stormcellar::level2
