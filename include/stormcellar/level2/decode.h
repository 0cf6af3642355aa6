// stormcellar/level2/decode.h -- bytes -> Volume.
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
#include <span>
#include <string>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/level2/decoded.h"
#include "stormcellar/level2/selection.h"

namespace stormcellar::level2 {

// What is compressed inside something compressed is held whole; no volume comes near this.
inline constexpr std::size_t most_packed_bytes = std::size_t{64} << 20;

struct DecodeOptions {
    int threads = 1;
    // Of the decompressed messages, of which little is held at a time.
    std::uint64_t output_limit_bytes = std::uint64_t{512} << 20;
    // Of all that is made of them and held; 0: the same.
    std::uint64_t array_limit_bytes = 0;
    [[nodiscard]] std::uint64_t most_array_bytes() const {
        return array_limit_bytes == 0 ? output_limit_bytes : array_limit_bytes;
    }
    // Of the sweep that is still open in a volume that grows, looked at after each record (0: as
    // much as arrays may take). Beyond it appending fails with over_budget.
    std::uint64_t open_sweep_limit_bytes = 0;
    // Arrays are made only for these; a cut that is not asked for gives no sweep.
    Selection selection;
    // Takes the station where the file does not say, e.g. from the file name; empty: unknown.
    std::string fallback_station;
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
