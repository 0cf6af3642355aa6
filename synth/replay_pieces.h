// synth/replay_pieces.h -- cuts a volume's file into pieces like the chunks of LDM.
//
// Threads   Pure functions.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace stormcellar::synth {

// Returns the ends of the pieces of a file, rising; the last end is the size of the file. A piece
// is an LDM record, together with a header that may precede it. A file without LDM records is cut
// into sixteenths.
[[nodiscard]] std::vector<std::size_t> piece_ends(std::span<const std::byte> bytes);

// Returns true if LDM records begin here or right after a header.
[[nodiscard]] bool has_ldm_records(std::span<const std::byte> bytes);

// Returns true if the control word of the last LDM record says that the volume ends.
[[nodiscard]] bool ends_volume(std::span<const std::byte> bytes);

}  // namespace stormcellar::synth
