// level2/containers/bzip2_stream.h -- where a bzip2 stream stands, and what of a damaged one is
// whole.
//
// bunzip gives out a block before it has checked it. So the output of a stream that fails is not
// to be used: BzipBlocks then reads its blocks one at a time and gives only those whose checksum
// is right, also the ones behind a damaged one.
// Thread contract: functions are pure; a BzipBlocks belongs to one thread.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "bunzip/bunzip.h"

namespace stormcellar::level2 {

// Bytes that tell a bzip2 stream: "BZh", a level, and the mark of a block or of the end.
inline constexpr std::size_t bzip2_mark_bytes = 10;
[[nodiscard]] bool is_bzip2(std::span<const std::byte> bytes);
// The first place at or after `from` where such a stream begins.
[[nodiscard]] std::optional<std::size_t> find_bzip2(std::span<const std::byte> bytes,
                                                    std::size_t from);
// Whether the last bytes are those of a bzip2 stream: the end mark, a checksum, less than a byte.
[[nodiscard]] bool ends_as_bzip2(std::span<const std::byte> bytes);

// The blocks of all streams in `bytes`, in order.
class BzipBlocks {
  public:
    // Both must outlive it.
    BzipBlocks(std::span<const std::byte> bytes, bunzip::Workspace& workspace);

    struct Block {
        bunzip::Status status = bunzip::Status::whole;  // else no output
        std::span<const std::byte> data;                // valid until the next call
        std::size_t position = 0;                       // in `bytes`, rounded down
        std::size_t compressed_bytes = 0;
        // What was unpacked in vain, in all that was tried for this block: half of it, as damage
        // costs several tries where a good block costs one. It took time all the same.
        std::uint64_t wasted_bytes = 0;
    };
    static constexpr std::uint64_t least_try_bytes = std::uint64_t{256} << 10;
    // What a try that failed is to count for.
    [[nodiscard]] static std::uint64_t waste_of(std::uint64_t unpacked_bytes) {
        return std::max(unpacked_bytes, least_try_bytes) / 2;
    }
    // None after the last, or after max_bad_blocks bad ones. A block of more than
    // `limit` bytes is too_large; its data are not given.
    static constexpr int max_bad_blocks = 1000;
    [[nodiscard]] std::optional<Block> next(std::size_t limit);
    // Whether the last stream had its end mark.
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
    std::vector<std::byte> stream_;  // one block, made a stream of its own
    std::vector<std::byte> output_;
    std::size_t output_bytes_ = 0;
    int bad_blocks_ = 0;
    bool ended_ = false;
};

}  // namespace stormcellar::level2
