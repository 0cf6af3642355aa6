// tests/hard_cases/unpacked_volume.h -- splits a file into its records and messages.
//
// The code is independent of the readers of level2. It tells a test where each part of a file is,
// so that the test can damage a chosen part. The code trusts its input: use it only for undamaged
// files, or for the intact start of a damaged file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "tests/level2/wire.h"

namespace stormcellar::level2 {

struct StreamMessage {
    int type = 0;  // -1: a 24-byte volume header inside the stream
    std::size_t offset = 0;
    std::size_t length = 0;
    std::optional<std::size_t> radial;  // number among all radials; none: no radial

    [[nodiscard]] std::size_t end() const { return offset + length; }
};

struct UnpackedVolume {
    wire::Bytes header;                // the first 24 bytes; empty if there is no header
    std::vector<wire::Bytes> records;  // with their control words; empty if the file is not LDM
    std::vector<std::size_t> radials_of_record;
    wire::Bytes stream;  // all messages, one after the other
    std::vector<StreamMessage> messages;
    std::size_t radials = 0;

    [[nodiscard]] wire::Bytes ldm_file() const;    // header and records, without gzip
    [[nodiscard]] wire::Bytes plain_file() const;  // header and stream
};

// Unpacks a file. Leaves out messages beyond the first `stream_limit` bytes of the stream.
[[nodiscard]] UnpackedVolume unpack(std::span<const std::byte> file,
                                    std::optional<std::uint64_t> stream_limit = std::nullopt);

// Returns a volume with only the first records and the last record: at most `most_bytes` compressed
// bytes, but at least three records.
[[nodiscard]] UnpackedVolume short_records(const UnpackedVolume& whole, std::size_t most_bytes);
// Returns a plain stream of three parts: the metadata without its fill frames, the first messages,
// and the last few messages.
[[nodiscard]] UnpackedVolume short_stream(const UnpackedVolume& whole, std::size_t most_bytes);

}  // namespace stormcellar::level2
