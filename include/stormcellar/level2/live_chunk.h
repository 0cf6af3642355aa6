// stormcellar/level2/live_chunk.h -- the decoded content of one chunk of a live volume. A depot
// (stormcellar/level2/sweep_depot.h) may store the chunk's sweeps.
//
// Units     Sizes are in bytes.
// Threads   Plain data; the functions have no state beyond their arguments.
// Errors    See each function.
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
    std::optional<VolumeHeader> header;  // if the chunk begins with a header
    std::vector<Fragment> fragments;     // the fragments of its records, in order
    bool has_records = false;            // false: the chunk has plain messages
    bool negative = false;               // the control word of the last record is negative
    bool ended_volume = false;           // a radial is marked as the last of the volume
    std::size_t radials = 0;
    std::size_t bytes = 0;
    std::uint64_t output_bytes = 0;  // decompressed
    std::uint64_t held_bytes = 0;    // memory of the fragments while the depot holds no sweep
    // For each piece, counted over all fragments, the place of its sweep in the depot, or none if
    // `fragments` holds the whole sweep. For a sweep in the depot, `fragments` keeps only the first
    // and the last radial. An empty list means that no sweep is in the depot.
    std::vector<std::optional<std::uint64_t>> places;
    std::uint64_t away_bytes = 0;  // the part of held_bytes that put_aside() moved into the depot
    std::uint64_t checksum = 0;
    ChunkKind kind = ChunkKind::intermediate;
    std::uint64_t serial = 0;  // the order of arrival
};

// The bytes that one chunk may take.
struct LiveRoom {
    std::uint64_t output_bytes = 0;
    std::uint64_t held_bytes = 0;
};

// Moves each sweep of three or more radials into the depot. A sweep stays in the chunk if the depot
// has no room for it.
void put_aside(LiveChunk& chunk, SweepDepot& depot);
// Returns the whole sweep of `piece`, which is piece number `place` counted over all fragments.
// `depot` may be null if no sweep is in a depot. Errors: those of the depot.
[[nodiscard]] Result<Sweep> whole_piece(const LiveChunk& chunk, std::size_t place,
                                        const Fragment::Piece& piece, const SweepDepot* depot);
// Brings all sweeps back from the depot. `depot` may be null if no sweep is in a depot. Errors:
// those of the depot.
[[nodiscard]] Status bring_back(LiveChunk& chunk, const SweepDepot* depot);

// Decodes a chunk; the caller sets kind and serial. Errors: empty; not_level2; corrupt or truncated
// if the chunk holds neither a whole header nor a whole message; unsupported if the chunk exceeds
// `room` or has more than 1000 records; exhausted if the system has no more memory. The function
// may also throw std::bad_alloc.
[[nodiscard]] Result<LiveChunk> read_live_chunk(std::span<const std::byte> bytes,
                                                const DecodeOptions& options, LiveRoom room);

}  // namespace stormcellar::level2
