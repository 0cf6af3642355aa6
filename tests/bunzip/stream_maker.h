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

// Compresses with libbz2, in blocks of level * 100,000 bytes.
[[nodiscard]] Bytes compressed(std::span<const std::byte> bytes, int level);

// The result of libbz2 for a stream that is fed in one piece.
struct LibraryOutcome {
    enum class Status : std::uint8_t { whole, truncated, corrupt, too_large } status;
    Bytes bytes;  // bytes that it returned
    std::size_t input_bytes = 0;
};
[[nodiscard]] LibraryOutcome decompressed(std::span<const std::byte> stream, std::size_t limit);

// All values of a block, each exactly as it is to be written, right or wrong.
struct BlockPlan {
    std::uint32_t checksum = 0;
    bool randomised = false;
    std::uint32_t origin = 0;
    std::vector<std::uint8_t> bytes;                 // those that occur, ascending
    std::vector<std::vector<std::uint8_t>> lengths;  // of the words of each code, by symbol
    std::vector<std::uint8_t> selectors;             // places in the list of codes, 0 to 6
    std::optional<std::uint32_t> stated_selectors;   // if not set, their number
    std::vector<std::uint16_t> symbols;              // each written in the code of its group
};
// Returns a whole stream; `end` is its last checksum, or none to leave the end out.
[[nodiscard]] Bytes stream_of(char level, std::span<const BlockPlan> blocks,
                              std::optional<std::uint32_t> end);

// Computes the checksum of bzip2 bit by bit.
[[nodiscard]] std::uint32_t slow_checksum(std::span<const std::byte> bytes);

// Returns a stream of one block with the checksums of what libbz2 decodes from it, so that it is
// valid if everything else in it is.
[[nodiscard]] Bytes mended_stream(char level, BlockPlan block);

// Returns a stream that the bytes of `choices` determine: valid, odd, or nearly valid.
[[nodiscard]] Bytes stream_from(std::span<const std::byte> choices);

}  // namespace stormcellar::bunzip
