// synth/replay_pieces.h -- the pieces in which a volume's file comes, as LDM's chunks.
//
// Threads: pure functions.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace stormcellar::synth {

// Where the pieces of a file end, rising; the last is its size. A piece is an LDM record (the first
// with the header before it; a second header in the midst begins a piece too). What has no LDM
// records comes in sixteenths.
[[nodiscard]] std::vector<std::size_t> piece_ends(std::span<const std::byte> bytes);

// Whether LDM records begin here, or behind a header.
[[nodiscard]] bool has_ldm_records(std::span<const std::byte> bytes);

// Whether the control word of the last LDM record says that the volume ends.
[[nodiscard]] bool ends_volume(std::span<const std::byte> bytes);

}  // namespace stormcellar::synth
