// level2/bzip2_stream.h -- bzip2 through libbz2: a whole stream at once, or block by block.
//
// libbz2 gives out a block before it has checked it. So the output of a stream that fails is not
// to be used: BzipBlocks then reads its blocks one at a time and gives only those whose checksum
// is right, also the ones behind a damaged one.
// Thread contract: functions are pure; a BzipBlocks belongs to one thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace stormcellar::level2 {

// Bytes that tell a bzip2 stream: "BZh", a level, and the mark of a block or of the end.
inline constexpr std::size_t bzip2_mark_bytes = 10;
[[nodiscard]] bool is_bzip2(std::span<const std::byte> bytes);
// The first place at or after `from` where such a stream begins.
[[nodiscard]] std::optional<std::size_t> find_bzip2(std::span<const std::byte> bytes,
                                                    std::size_t from);
// Whether the last bytes are those of a bzip2 stream: the end mark, a checksum, less than a byte.
[[nodiscard]] bool ends_as_bzip2(std::span<const std::byte> bytes);

enum class BzipStatus : std::uint8_t { whole, truncated, corrupt, too_large, no_memory };

struct BzipResult {
    BzipStatus status = BzipStatus::whole;
    std::size_t output_bytes = 0;  // at the start of the buffer
    std::size_t input_bytes = 0;   // that the stream took
};

// One stream, decompressed as far as there is room. What it gives is checked only when the stream
// has ended: see above.
class BzipReader {
  public:
    explicit BzipReader(std::span<const std::byte> stream);
    BzipReader(const BzipReader&) = delete;
    BzipReader& operator=(const BzipReader&) = delete;
    ~BzipReader();

    // Fills `out` as far as the stream goes and says how many bytes; fewer only at its end.
    [[nodiscard]] std::size_t read(std::span<std::byte> out);
    [[nodiscard]] bool ended() const { return ended_; }
    // What ended it: whole only where all checksums are right.
    [[nodiscard]] BzipStatus status() const { return status_; }
    [[nodiscard]] std::size_t input_bytes() const;  // that the stream took

  private:
    struct State;
    std::span<const std::byte> stream_;
    std::unique_ptr<State> state_;
    bool ended_ = false;
    BzipStatus status_ = BzipStatus::whole;
};

// Decompresses one stream into `buffer`, which grows as needed up to `limit` and never shrinks.
[[nodiscard]] BzipResult bunzip(std::span<const std::byte> stream, std::vector<std::byte>& buffer,
                                std::size_t limit);

// The blocks of all streams in `bytes`, in order.
class BzipBlocks {
  public:
    explicit BzipBlocks(std::span<const std::byte> bytes);

    struct Block {
        BzipStatus status = BzipStatus::whole;  // else no output
        std::span<const std::byte> data;        // valid until the next call
        std::size_t position = 0;               // in `bytes`, rounded down
        std::size_t compressed_bytes = 0;
    };
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
    [[nodiscard]] BzipStatus unpack(std::uint64_t begin_bit, std::uint64_t end_bit,
                                    std::size_t limit);

    std::span<const std::byte> bytes_;
    std::optional<Mark> mark_;
    std::vector<std::byte> stream_;  // one block, made a stream of its own
    std::vector<std::byte> output_;
    std::size_t output_bytes_ = 0;
    int bad_blocks_ = 0;
    bool ended_ = false;
};

}  // namespace stormcellar::level2
