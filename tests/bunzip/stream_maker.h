// tests/bunzip/stream_maker.h -- makes, bit by bit, bzip2 streams that no compressor writes.
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
    Bytes bytes;  // the output
    std::size_t input_bytes = 0;
};
[[nodiscard]] LibraryOutcome decompressed(std::span<const std::byte> stream, std::size_t limit);

// The values of all fields of a block. stream_of() writes them unchanged, right or wrong.
struct BlockPlan {
    std::uint32_t checksum = 0;
    bool randomised = false;
    std::uint32_t origin = 0;
    std::vector<std::uint8_t> bytes;                 // the bytes that occur, ascending
    std::vector<std::vector<std::uint8_t>> lengths;  // for each code, word lengths by symbol
    std::vector<std::uint8_t> selectors;             // places in the list of codes, 0 to 6
    std::optional<std::uint32_t> stated_selectors;   // none: the number of `selectors`
    std::vector<std::uint16_t> symbols;              // written in the codes of their groups
};
// Returns a stream of these blocks. `end` is the checksum at the end of the stream. Without `end`,
// the stream is cut before that checksum.
[[nodiscard]] Bytes stream_of(char level, std::span<const BlockPlan> blocks,
                              std::optional<std::uint32_t> end);

// Computes the checksum of bzip2 bit by bit.
[[nodiscard]] std::uint32_t slow_checksum(std::span<const std::byte> bytes);

// Returns a stream of one block, with the checksums that fit the bytes that libbz2 decodes from it.
// So the stream is valid if all other fields of the block are valid.
[[nodiscard]] Bytes mended_stream(char level, BlockPlan block);

// Returns a valid, odd or nearly valid stream. `choices` determines every byte.
[[nodiscard]] Bytes stream_from(std::span<const std::byte> choices);

}  // namespace stormcellar::bunzip
