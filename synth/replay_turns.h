// synth/replay_turns.h -- computes the start, the duration and the name of each file of a replay.
//
// Threads   Pure functions.
#pragma once

#include <filesystem>
#include <vector>

#include "synth/replay.h"

namespace stormcellar::synth {

// Times are in seconds of the replay.
struct ReplayTurn {
    double start_s = 0;
    double span_s = 0;  // from the first piece to the end of the turn of the last piece
};
[[nodiscard]] std::vector<ReplayTurn> turns_of(const std::vector<ReplayItem>& items,
                                               const ReplayOptions& options);

// Returns the target of each item below the drop directory: the file, or, for chunks, the directory
// of the volume. Errors: bad_argument as in replay().
[[nodiscard]] Result<std::vector<std::filesystem::path>> targets_of(
    const std::vector<ReplayItem>& items, Delivery delivery);

}  // namespace stormcellar::synth
