// level2/containers/bzip2_stream.h -- finds bzip2 streams, and recovers the whole blocks of a
// damaged stream.
//
// bunzip returns the bytes of a block before it has checked them, so the output of a stream that
// fails must not be used. BzipBlocks then reads the blocks of the stream one at a time and returns
// only blocks with the right checksum, also after a damaged block.
//
// Threads   Pure functions. A BzipBlocks may be used by one thread at a time.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "bunzip/bunzip.h"

namespace stormcellar::level2 {

// The bytes that identify a bzip2 stream: "BZh", a level, and the mark of a block or of the end.
inline constexpr std::size_t bzip2_mark_bytes = 10;
[[nodiscard]] bool is_bzip2(std::span<const std::byte> bytes);
// Returns the first place at or after `from` where a bzip2 stream begins, or none.
[[nodiscard]] std::optional<std::size_t> find_bzip2(std::span<const std::byte> bytes,
                                                    std::size_t from);
// Returns true if the bytes end as a bzip2 stream does: with the end mark, a checksum, and less
// than a byte of padding.
[[nodiscard]] bool ends_as_bzip2(std::span<const std::byte> bytes);

// Reads the blocks of all streams in `bytes`, in order.
class BzipBlocks {
  public:
    // Both arguments must outlive the object.
    BzipBlocks(std::span<const std::byte> bytes, bunzip::Workspace& workspace);

    struct Block {
        bunzip::Status status = bunzip::Status::whole;  // `data` is empty unless whole
        std::span<const std::byte> data;                // valid until the next call
        std::size_t position = 0;                       // of the first byte of the block in `bytes`
        std::size_t compressed_bytes = 0;
        // The sum of waste_of() over the failed tries for this block, which counts as output.
        std::uint64_t wasted_bytes = 0;
    };
    static constexpr std::uint64_t least_try_bytes = std::uint64_t{256} << 10;
    // Returns the bytes of output that count for a failed try that unpacked this many bytes. A try
    // counts because unpacking took time, but only half, because a damaged block costs several
    // tries.
    [[nodiscard]] static std::uint64_t waste_of(std::uint64_t unpacked_bytes) {
        return std::max(unpacked_bytes, least_try_bytes) / 2;
    }
    // Returns the next block, or none after the last one or after max_bad_blocks bad blocks. A
    // block of more than `limit` bytes is too_large, and has no data.
    static constexpr int max_bad_blocks = 1000;
    [[nodiscard]] std::optional<Block> next(std::size_t limit);
    // Returns true if the last stream had its end mark.
    [[nodiscard]] bool ended() const { return ended_; }

  private:
    struct Mark {
        std::uint64_t bit = 0;
        bool end_of_stream = false;
    };
    [[nodiscard]] std::optional<Mark> find_mark(std::uint64_t from_bit) const;
    [[nodiscard]] bunzip::Status unpack(std::uint64_t begin_bit, std::uint64_t end_bit,
                                        std::size_t limit);

    std::span<const std::byte> bytes_;
    bunzip::Workspace& workspace_;
    std::optional<Mark> mark_;
    std::vector<std::byte> stream_;  // one block, made into a stream of its own
    std::vector<std::byte> output_;
    std::size_t output_bytes_ = 0;
    int bad_blocks_ = 0;
    bool ended_ = false;
};

}  // namespace stormcellar::level2
