// level2/live/open_sweep.h -- groups the pieces in a live volume's chunks into sweeps.
//
// Threads   Pure functions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "stormcellar/level2/live_chunk.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::level2 {

// The pieces that make up a sweep. They point into the chunks, which must outlive the OpenSweep.
struct OpenSweep {
    // Identifies a piece: the serial number of its chunk, and its index in that chunk.
    using PieceId = std::pair<std::uint64_t, std::size_t>;

    struct OpenPiece {
        const Fragment::Piece* piece = nullptr;
        const LiveChunk* chunk = nullptr;
        std::size_t place = 0;  // index of the piece in the chunk
    };
    std::vector<OpenPiece> pieces;
    std::vector<PieceId>
        ids;  // first the serial number + 1 of the chunk that gave the pattern, then the pieces
    const Vcp* pattern = nullptr;
    bool closed = false;  // by the status of its last radial, or by a later sweep
};

// Groups the pieces of all chunks, in the order of the chunk numbers, by the same rule as
// VolumeBuilder.
[[nodiscard]] std::vector<OpenSweep> sweeps_of(const std::map<int, LiveChunk>& chunks);

// Joins the pieces in the same way as VolumeBuilder. Returns a sweep without radials if the sweep
// exceeds the limit. `depot` may be null if no sweep is stored in a SweepDepot. Errors: those of
// the depot.
[[nodiscard]] Result<Sweep> join(const OpenSweep& sweep, std::uint64_t limit_bytes,
                                 const SweepDepot* depot);

}  // namespace stormcellar::level2
