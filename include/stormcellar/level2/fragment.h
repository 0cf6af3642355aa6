// stormcellar/level2/fragment.h -- the contents of a stretch of the message stream, decoded by
// itself.
//
// An LDM record, a live chunk or a run of messages becomes a Fragment without knowing what stood
// before it; a VolumeBuilder joins fragments in their order. So records can be decoded by several
// threads and chunks in the order in which they arrive, and the volume does not depend on either.
// Thread contract: plain data.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "stormcellar/level2/decode_report.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::level2 {

// What stands between radials.
struct FragmentMarks {
    std::vector<Vcp> patterns;           // messages 5 and 7, in their order
    std::optional<VolumeHeader> header;  // the last 24-byte header inside the stream
};

struct Fragment {
    // Radials one behind the other that belong to one sweep.
    struct Piece {
        FragmentMarks before;
        Sweep sweep;            // never without radials; without vcp_elevation_deg
        std::uint16_t vcp = 0;  // that its first radial names; 0: none
        // Its cut is not asked for: the sweep holds only its first radial, and its last.
        bool left_out = false;
    };
    std::vector<Piece> pieces;
    FragmentMarks behind;  // after the last piece
    std::string station;   // the first ICAO of a message 31
    std::optional<VolumeBlock> block;
    std::uint16_t vcp = 0;  // the first that a radial names
    // Offsets count from where the fragment begins, LDM records from 1.
    DecodeReport report;
    // Decompressed, whether messages or not, and half of what was in vain (BzipBlocks::Block).
    std::uint64_t output_bytes = 0;
    std::uint64_t array_bytes = 0;  // what radials, rows and patterns take, see ArrayRoom
    // Of the errors in the report those behind the last radial; all where there is none.
    std::uint64_t errors_behind = 0;
    bool cut = false;  // the input ends too early
    enum class Failure : std::uint8_t { none, no_memory, too_much_output, too_large_arrays };
    Failure failure = Failure::none;  // the fragment is not whole, for want of room
};

}  // namespace stormcellar::level2
