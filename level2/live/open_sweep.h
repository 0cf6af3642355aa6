// level2/live/open_sweep.h -- finds the pieces in a live volume's chunks that make up a sweep.
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

// A sweep by its pieces. It refers to the chunks from which it was made.
struct OpenSweep {
    // The serial number of the chunk of a piece, and the index of the piece in the chunk.
    using PieceId = std::pair<std::uint64_t, std::size_t>;

    struct OpenPiece {
        const Fragment::Piece* piece = nullptr;
        const LiveChunk* chunk = nullptr;
        std::size_t place = 0;  // index in the chunk
    };
    std::vector<OpenPiece> pieces;
    std::vector<PieceId>
        ids;  // after the ID of the chunk that gave the pattern, which counts from 1
    const Vcp* pattern = nullptr;
    bool closed = false;  // closed by the status of its last radial, or by what follows
};

// Groups the pieces by the rule of the VolumeBuilder, over the chunks in the order of their
// numbers.
[[nodiscard]] std::vector<OpenSweep> sweeps_of(const std::map<int, LiveChunk>& chunks);

// Joins the pieces in the same way as the VolumeBuilder. Returns a sweep without radials if that
// exceeds the limit. Errors: those of the depot (null: no sweep is in a depot).
[[nodiscard]] Result<Sweep> join(const OpenSweep& sweep, std::uint64_t limit_bytes,
                                 const SweepDepot* depot);

}  // namespace stormcellar::level2
