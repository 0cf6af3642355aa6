// stormcellar/level2/decode_report.h -- what a decoder saw, kept and dropped.
// Thread contract: plain data; const access from many threads is safe.
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
    // Into the message stream after the 24-byte header; for a damaged container into the file.
    std::optional<std::uint64_t> offset;
    std::optional<std::uint64_t> ldm_record;  // the number of the record that is bad, from 1
    // How many messages it is true of, where the same is said of many: offset and record are then
    // those of the first. 0: it is said of one place.
    std::uint64_t count = 0;
    std::uint64_t dropped_bytes = 0;  // of these messages together

    // The message, behind the number of its record, with how often it is true.
    [[nodiscard]] std::string text() const;
};

struct DecodeReport {
    std::string container;                     // e.g. "gzip+ldm-bzip2", "uncompressed"
    std::optional<std::uint64_t> ldm_records;  // none where there are no LDM records
    std::optional<std::uint64_t> negative_control_words;
    std::uint64_t message_bytes = 0;  // decompressed, behind the 24-byte header
    std::map<int, std::uint64_t> message_counts;
    std::uint64_t bytes_dropped = 0;  // of messages; of the file where a compressed part is lost
    std::vector<Problem> problems;    // the first max_problems, and those that have a count
    static constexpr std::size_t max_problems = 100;
    std::uint64_t problems_left_out = 0;
    std::uint64_t errors = 0;  // problems of that severity, listed or not
    // Where a message was first due and none was, as in the golden files; none for an undamaged
    // stream. What was dropped for it may begin earlier: a problem has that.
    struct Corruption {
        std::uint64_t offset = 0;
        std::string reason;
    };
    std::optional<Corruption> corruption;
    // The last radial ended its volume (status 4), no volume before it was given up, nothing is
    // missing, and up to that radial nothing was dropped and no problem is an error. What stands
    // behind it does not count.
    bool complete = false;
    bool damaged = false;               // before the last radial something was dropped or is wrong
    std::uint64_t sweeps_left_out = 0;  // whose cuts were not asked for
    std::uint64_t records_skipped =
        0;  // of these, not even decompressed; offsets do not count them
    // Sweep indices at which a further volume begins: at a start-of-volume radial, after a second
    // header, where the elevation number falls, and where it does not rise after an end of volume.
    // Volume 0 begins at sweep 0. A volume of which a selection leaves no sweep has the same start
    // as the next one.
    std::vector<std::size_t> further_volume_starts;
    // 24-byte headers found inside the stream, with the sweep that follows each.
    struct FurtherHeader {
        std::size_t sweep = 0;
        VolumeHeader header;
        std::size_t start = 0;  // the place of its volume in further_volume_starts
    };
    std::vector<FurtherHeader> further_headers;
    // The pattern of each further volume, in their order, as Volume has that of the first.
    struct FurtherPattern {
        std::size_t sweep = 0;
        std::optional<Vcp> message;
        std::optional<int> vcp;
        VcpSource source = VcpSource::none;
    };
    std::vector<FurtherPattern> further_patterns;
    std::string message_station;  // ICAO of message 31; empty where there is none
    std::map<int, std::uint64_t> radial_compression;  // message 31: indicator, radials
    std::optional<RdaStatus> rda_status;              // the last message 2
    double decompress_s = 0;  // CPU seconds in decompression, all threads added
};

}  // namespace stormcellar::level2
