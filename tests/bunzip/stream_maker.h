// tests/bunzip/stream_maker.h -- bzip2 streams that no compressor writes, bit by bit.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace stormcellar::bunzip {

using Bytes = std::vector<std::byte>;

[[nodiscard]] Bytes bytes_of(std::string_view text);

// As libbz2 compresses it, blocks of level * 100,000 bytes.
[[nodiscard]] Bytes compressed(std::span<const std::byte> bytes, int level);

// What libbz2 makes of a stream, fed whole.
struct LibraryOutcome {
    enum class Status : std::uint8_t { whole, truncated, corrupt, too_large } status;
    Bytes bytes;  // that it gave out
    std::size_t input_bytes = 0;
};
[[nodiscard]] LibraryOutcome decompressed(std::span<const std::byte> stream, std::size_t limit);

// All that a block says, each of it as wanted and not as it should be.
struct BlockPlan {
    std::uint32_t checksum = 0;
    bool randomised = false;
    std::uint32_t origin = 0;
    std::vector<std::uint8_t> bytes;                 // that occur, ascending
    std::vector<std::vector<std::uint8_t>> lengths;  // of each code's words, by symbol
    std::vector<std::uint8_t> selectors;             // places in the list of codes, 0 to 6
    std::optional<std::uint32_t> stated_selectors;   // else their number
    std::vector<std::uint16_t> symbols;              // each as the code of its group has it
};
// A whole stream; `end` is its last checksum, none leaves the end away.
[[nodiscard]] Bytes stream_of(char level, std::span<const BlockPlan> blocks,
                              std::optional<std::uint32_t> end);

// bzip2's checksum, bit by bit.
[[nodiscard]] std::uint32_t slow_checksum(std::span<const std::byte> bytes);

// A stream of one block whose checksums are those of what libbz2 makes of it, so that it is whole
// where all else of it is right.
[[nodiscard]] Bytes mended_stream(char level, BlockPlan block);

// Any stream that can be thought of, from bytes that decide: valid, odd, or nearly so.
[[nodiscard]] Bytes stream_from(std::span<const std::byte> choices);

}  // namespace stormcellar::bunzip
