// synth/replay_pieces.h -- cuts a volume's file into the pieces in which it comes, like LDM's
// chunks.
//
// Threads   Pure functions.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace stormcellar::synth {

// Returns the ends of the pieces of a file, rising; the last one is the file's size. A piece is an
// LDM record; a header belongs to the piece of the record after it. A file without LDM records
// comes in sixteenths.
[[nodiscard]] std::vector<std::size_t> piece_ends(std::span<const std::byte> bytes);

// Returns true if LDM records begin here or after a header.
[[nodiscard]] bool has_ldm_records(std::span<const std::byte> bytes);

// Returns true if the control word of the last LDM record says that the volume ends.
[[nodiscard]] bool ends_volume(std::span<const std::byte> bytes);

}  // namespace stormcellar::synth
