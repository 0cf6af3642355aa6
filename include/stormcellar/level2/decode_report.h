// stormcellar/level2/decode_report.h -- what a decoder found, kept and dropped.
//
// Units     Offsets and sizes are in bytes; times are in seconds.
// Threads   Plain data; any thread may read it while no thread writes it.
// Errors    None.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "stormcellar/level2/rda_status.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::level2 {

enum class Severity : std::uint8_t { note, warning, error };
[[nodiscard]] std::string_view severity_name(Severity severity);

struct Problem {
    Severity severity = Severity::warning;
    std::string code;     // short and stable, e.g. "truncated_record"
    std::string message;  // one line for a person
    // Offset in the message stream, counted after the 24-byte header; for a damaged container,
    // offset in the file.
    std::optional<std::uint64_t> offset;
    std::optional<std::uint64_t> ldm_record;  // the bad record; counts from 1
    // Number of messages with this problem, if one Problem covers many messages. Then `offset` and
    // `ldm_record` belong to the first message. The count is 0 if the Problem describes one place.
    std::uint64_t count = 0;
    std::uint64_t dropped_bytes = 0;  // of all these messages together

    // Returns `message` with the record number before it, and the dropped bytes and the count after
    // it.
    [[nodiscard]] std::string text() const;
};

struct DecodeReport {
    std::string container;                     // e.g. "gzip+ldm-bzip2", "uncompressed"
    std::optional<std::uint64_t> ldm_records;  // none if there are no LDM records
    std::optional<std::uint64_t> negative_control_words;
    std::uint64_t message_bytes = 0;  // decompressed, after the 24-byte header
    std::map<int, std::uint64_t> message_counts;
    std::uint64_t bytes_dropped = 0;  // of messages, or of the file if a compressed part is lost
    std::vector<Problem> problems;    // all with a count, and at most max_problems without
    static constexpr std::size_t max_problems = 100;
    std::uint64_t problems_left_out = 0;
    std::uint64_t errors = 0;  // number of problems that are errors, listed or not
    // First place where the decoder expected a message and found none; empty for an undamaged
    // stream. The dropped bytes may begin earlier; the Problem has the offset of the first dropped
    // byte. The golden files (tests/level2/golden_test.cpp) use the same definition.
    struct Corruption {
        std::uint64_t offset = 0;
        std::string reason;
    };
    std::optional<Corruption> corruption;
    // True if the last radial ended its volume (status 4), no earlier volume was broken off,
    // nothing is missing, and up to that radial nothing was dropped and no problem is an error.
    // Bytes after that radial do not count.
    bool complete = false;
    // True if a problem before the last radial is an error, a chunk is missing, or the checksum of
    // the gzip layer is wrong.
    bool damaged = false;
    std::uint64_t sweeps_left_out = 0;  // sweeps of cuts that are not selected
    // records of such sweeps that the decoder skipped; offsets do not count their bytes
    std::uint64_t records_skipped = 0;
    // The sweep indices at which further volumes begin. A volume begins at a start-of-volume radial
    // and after a second header. While time goes forward, a volume also begins where the elevation
    // number falls, and where it does not rise after an end of volume. Volume 0 begins at sweep 0.
    // If a selection leaves no sweep of a volume, that volume has the same start as the next
    // volume.
    std::vector<std::size_t> further_volume_starts;
    // The 24-byte headers found inside the stream, each with the sweep that follows it.
    struct FurtherHeader {
        std::size_t sweep = 0;
        VolumeHeader header;
        std::size_t start = 0;  // index of its volume in further_volume_starts
    };
    std::vector<FurtherHeader> further_headers;
    // The pattern of each further volume, in order. The Volume itself has the pattern of the first
    // volume.
    struct FurtherPattern {
        std::size_t sweep = 0;
        std::optional<Vcp> message;
        std::optional<int> vcp;
        VcpSource source = VcpSource::none;
    };
    std::vector<FurtherPattern> further_patterns;
    std::string message_station;  // ICAO in message 31; empty if it has none
    // for message 31: radials by compression indicator
    std::map<int, std::uint64_t> radial_compression;
    std::optional<RdaStatus> rda_status;  // from the last message 2
    double decompress_s = 0;              // CPU seconds of decompression, summed over all threads
};

}  // namespace stormcellar::level2
