// level2/live_chunk.h -- one chunk of a live volume, decoded by itself.
// Thread contract: functions are pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "base/result.h"
#include "level2/chunk_name.h"
#include "level2/decode.h"
#include "level2/fragment.h"

namespace stormcellar::level2 {

struct LiveChunk {
    std::optional<VolumeHeader> header;  // at its start
    std::vector<Fragment> fragments;     // of its records, in their order
    bool has_records = false;            // else plain messages
    bool negative = false;               // the last record's control word
    bool ended_volume = false;           // a radial says so
    std::size_t radials = 0;
    std::size_t bytes = 0;
    std::uint64_t output_bytes = 0;  // decompressed
    std::uint64_t held_bytes = 0;    // in its fragments
    std::uint64_t checksum = 0;
    ChunkKind kind = ChunkKind::intermediate;
    std::uint64_t serial = 0;  // of its arrival
};

// What a chunk may take.
struct LiveRoom {
    std::uint64_t output_bytes = 0;
    std::uint64_t held_bytes = 0;
};

// Without kind and serial. Errors: empty; not_level2; corrupt or truncated where nothing is whole,
// neither a header nor a message; unsupported beyond the room or the system's memory. Throws
// std::bad_alloc.
[[nodiscard]] Result<LiveChunk> read_live_chunk(std::span<const std::byte> bytes,
                                                const DecodeOptions& options, LiveRoom room);

}  // namespace stormcellar::level2
