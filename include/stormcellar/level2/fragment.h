// stormcellar/level2/fragment.h -- the decoded content of one stretch of the message stream.
//
// An LDM record, a live chunk or a run of messages becomes a Fragment without any knowledge of
// earlier bytes. A VolumeBuilder joins fragments in the order of the stream. So several threads can
// decode records, and chunks can be decoded in any order, without changing the volume.
//
// Threads   Plain data.
// Errors    See Fragment::failure.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "stormcellar/level2/decode_report.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::level2 {

// Facts that the message stream gives between two radials.
struct FragmentMarks {
    std::vector<Vcp> patterns;           // messages 5 and 7, in order
    std::optional<VolumeHeader> header;  // the last 24-byte header inside the stream
};

struct Fragment {
    // A run of consecutive radials that belong to one sweep.
    struct Piece {
        FragmentMarks before;
        Sweep sweep;            // has radials, but no vcp_elevation_deg
        std::uint16_t vcp = 0;  // the VCP named by the first radial; 0: none
        // True if the cut of the piece is not selected. `sweep` then holds only the first and the
        // last radial, without moments.
        bool left_out = false;
    };
    std::vector<Piece> pieces;
    FragmentMarks behind;  // facts after the last piece
    std::string station;   // the first ICAO in a message 31
    std::optional<VolumeBlock> block;
    std::uint16_t vcp = 0;  // the first VCP named by a radial
    // Offsets count from the beginning of the fragment, LDM records from 1.
    DecodeReport report;
    // The number of decompressed bytes, messages or not, plus BzipBlocks::waste_of() for failed
    // attempts to decompress.
    std::uint64_t output_bytes = 0;
    std::uint64_t array_bytes = 0;  // of radials, rows and patterns, as ArrayRoom counts
    // Number of errors in `report` after the last radial; all errors if there is no radial.
    std::uint64_t errors_behind = 0;
    bool cut = false;  // the input ends too early
    enum class Failure : std::uint8_t { none, no_memory, too_much_output, too_large_arrays };
    Failure failure = Failure::none;  // the limit that cut the fragment short
};

}  // namespace stormcellar::level2
