// level2/live/open_sweep.h -- which pieces of a live volume's chunks make a sweep.
// Thread contract: functions are pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "stormcellar/level2/live_chunk.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::level2 {

// Points into the chunks that it was made of.
struct OpenSweep {
    // The serial number of a piece's chunk, and its place there.
    using PieceId = std::pair<std::uint64_t, std::size_t>;

    struct OpenPiece {
        const Fragment::Piece* piece = nullptr;
        const LiveChunk* chunk = nullptr;
        std::size_t place = 0;  // in the chunk
    };
    std::vector<OpenPiece> pieces;
    std::vector<PieceId>
        ids;  // behind that of the chunk that gave the pattern, which counts from 1
    const Vcp* pattern = nullptr;
    bool closed = false;  // by its last radial's status, or by what follows
};

// By the rule of the VolumeBuilder, over the chunks in the order of their numbers.
[[nodiscard]] std::vector<OpenSweep> sweeps_of(const std::map<int, LiveChunk>& chunks);

// The pieces as the VolumeBuilder joins them; a sweep without radials where that exceeds the limit.
// Errors: those of the depot (null: nothing lies elsewhere).
[[nodiscard]] Result<Sweep> join(const OpenSweep& sweep, std::uint64_t limit_bytes,
                                 const SweepDepot* depot);

}  // namespace stormcellar::level2
