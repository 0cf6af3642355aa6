// level2/decode.h -- bytes -> Volume.
//
// Containers are found by content, never by name, and peeled in a loop: gzip, whole-file bzip2,
// then a 24-byte header or none, then LDM bzip2 records or plain 2432-byte frames and message 31.
// Input is hostile: every length is bounded before use. What is whole is kept; what is not is
// named in the report. Never a made-up sweep, never half a radial.
// Errors: empty (no bytes), not_level2 (nothing recognised), corrupt or truncated (recognised, but
// neither a whole radial nor metadata could be read), unsupported (output limit exceeded).
// Thread contract: functions are pure; decode() may use `threads` worker threads of its own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"
#include "level2/volume.h"

namespace stormcellar::level2 {

enum class Severity : std::uint8_t { note, warning, error };
[[nodiscard]] std::string_view severity_name(Severity severity);

struct Problem {
    Severity severity = Severity::warning;
    std::string code;     // short and stable, e.g. "truncated_record"
    std::string message;  // one line for a person
    // Into the message stream after the 24-byte header; for a damaged container into the file.
    std::optional<std::uint64_t> offset;
};

struct DecodeReport {
    std::string container;                     // e.g. "gzip+ldm-bzip2", "uncompressed"
    std::optional<std::uint64_t> ldm_records;  // none where there are no LDM records
    std::optional<std::uint64_t> negative_control_words;
    std::uint64_t message_bytes = 0;  // decompressed, behind the 24-byte header
    std::map<int, std::uint64_t> message_counts;
    std::uint64_t bytes_dropped = 0;  // of messages; of the file where a compressed part is lost
    std::vector<Problem> problems;
    // Where a message was first due and none was, as in the golden files; none for an undamaged
    // stream. What was dropped for it may begin earlier: a problem has that.
    struct Corruption {
        std::uint64_t offset = 0;
        std::string reason;
    };
    std::optional<Corruption> corruption;
    // The last radial ended its volume (status 4) and nothing was dropped.
    bool complete = false;
    // Sweep indices at which a further volume begins: at a start-of-volume radial, after a second
    // header, where the elevation number falls, and where it does not rise after an end of volume.
    // Volume 0 begins at sweep 0.
    std::vector<std::size_t> further_volume_starts;
    // 24-byte headers found inside the stream, with the sweep that follows each.
    struct FurtherHeader {
        std::size_t sweep = 0;
        VolumeHeader header;
    };
    std::vector<FurtherHeader> further_headers;
    // The pattern of each further volume, as Volume has that of the first.
    struct FurtherPattern {
        std::size_t sweep = 0;
        std::optional<Vcp> message;
        std::optional<int> vcp;
        VcpSource source = VcpSource::none;
    };
    std::vector<FurtherPattern> further_patterns;
    std::string message_station;  // ICAO of message 31; empty where there is none
    std::map<int, std::uint64_t> radial_compression;  // message 31: indicator, radials
    double decompress_s = 0;  // CPU seconds in decompression, all threads added
};

struct DecodeOptions {
    int threads = 1;
    std::uint64_t output_limit_bytes = std::uint64_t{1} << 30;
    // Takes the station where the file does not say, e.g. from the file name; empty: unknown.
    std::string fallback_station;
};

struct Decoded {
    Volume volume;
    DecodeReport report;
};

[[nodiscard]] Result<Decoded> decode(std::span<const std::byte> bytes,
                                     const DecodeOptions& options = {});

// Reads and decodes a file; the station falls back to the first four characters of its name when
// they are an ICAO in the station table. Messages of errors begin with the path.
[[nodiscard]] Result<Decoded> decode_file(const std::filesystem::path& path,
                                          const DecodeOptions& options = {});

// The volumes of a file that holds several, each with its share of the sweeps; block and VCP are
// repeated. A further volume has its own header where the file holds one, else the first with the
// time of its own first radial, since a start time names a volume. One element for an ordinary
// file.
[[nodiscard]] std::vector<Volume> split_volumes(Decoded decoded);

}  // namespace stormcellar::level2
