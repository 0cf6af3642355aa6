// stormcellar/level2/live_chunk.h -- one chunk of a live volume, decoded by itself.
// Thread contract: no state but what is given.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/level2/chunk_name.h"
#include "stormcellar/level2/decode.h"
#include "stormcellar/level2/fragment.h"
#include "stormcellar/level2/sweep_depot.h"

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
    std::uint64_t held_bytes = 0;    // in its fragments, when all of them is here
    // Of each piece, over all fragments, where all of its sweep lies, if not here: what is left of
    // that are its first radial and its last. Empty: everything is here.
    std::vector<std::optional<std::uint64_t>> places;
    std::uint64_t away_bytes = 0;  // of held_bytes
    std::uint64_t checksum = 0;
    ChunkKind kind = ChunkKind::intermediate;
    std::uint64_t serial = 0;  // of its arrival
};

// What a chunk may take.
struct LiveRoom {
    std::uint64_t output_bytes = 0;
    std::uint64_t held_bytes = 0;
};

// Puts what is large into the depot, as far as it takes it.
void put_aside(LiveChunk& chunk, SweepDepot& depot);
// The whole sweep of a piece; `place` counts over all fragments. Errors: those of the depot.
[[nodiscard]] Result<Sweep> whole_piece(const LiveChunk& chunk, std::size_t place,
                                        const Fragment::Piece& piece, const SweepDepot* depot);
// All pieces are here again.
[[nodiscard]] Status bring_back(LiveChunk& chunk, const SweepDepot* depot);

// Without kind and serial. Errors: empty; not_level2; corrupt or truncated where nothing is whole,
// neither a header nor a message; unsupported beyond the room; exhausted where the system gives no
// memory, or std::bad_alloc is thrown.
[[nodiscard]] Result<LiveChunk> read_live_chunk(std::span<const std::byte> bytes,
                                                const DecodeOptions& options, LiveRoom room);

}  // namespace stormcellar::level2
