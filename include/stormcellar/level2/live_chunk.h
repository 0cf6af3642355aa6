// stormcellar/level2/live_chunk.h -- one chunk of a live volume, decoded by itself.
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
    std::optional<VolumeHeader> header;  // the header at its start
    std::vector<Fragment> fragments;     // the fragments of its records, in order
    bool has_records = false;            // false: it has plain messages
    bool negative = false;               // the control word of the last record
    bool ended_volume = false;           // a radial says that the volume ends
    std::size_t radials = 0;
    std::size_t bytes = 0;
    std::uint64_t output_bytes = 0;  // decompressed
    std::uint64_t held_bytes = 0;    // memory of the fragments while the depot holds no sweep
    // The place in the depot of the sweep of each piece, counted over all fragments, or none if the
    // sweep is here. For a sweep in the depot, only its first and its last radial stay here. An
    // empty list means that all sweeps are here.
    std::vector<std::optional<std::uint64_t>> places;
    std::uint64_t away_bytes = 0;  // the part of held_bytes in the depot
    std::uint64_t checksum = 0;
    ChunkKind kind = ChunkKind::intermediate;
    std::uint64_t serial = 0;  // the order of arrival
};

// The room for one chunk.
struct LiveRoom {
    std::uint64_t output_bytes = 0;
    std::uint64_t held_bytes = 0;
};

// Puts large sweeps into the depot, as far as the depot takes them.
void put_aside(LiveChunk& chunk, SweepDepot& depot);
// Returns the whole sweep of a piece. `place` counts pieces over all fragments. Errors: those of
// the depot.
[[nodiscard]] Result<Sweep> whole_piece(const LiveChunk& chunk, std::size_t place,
                                        const Fragment::Piece& piece, const SweepDepot* depot);
// Brings all pieces back from the depot. Errors: those of the depot.
[[nodiscard]] Status bring_back(LiveChunk& chunk, const SweepDepot* depot);

// Decodes a chunk; the caller sets kind and serial. Errors: empty; not_level2; corrupt or truncated
// if it holds neither a whole header nor a whole message; unsupported beyond the room; exhausted if
// the system has no more memory. It may also throw std::bad_alloc.
[[nodiscard]] Result<LiveChunk> read_live_chunk(std::span<const std::byte> bytes,
                                                const DecodeOptions& options, LiveRoom room);

}  // namespace stormcellar::level2
