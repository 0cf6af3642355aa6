// stormcellar/level2/decode.h -- decodes the bytes of a Level II file into a Volume.
//
// The decoder recognizes containers by content, never by name. It unpacks gzip, bzip2 or .Z around
// the whole file, in several layers if need be. The content begins with a 24-byte header, which may
// be missing. LDM bzip2 records follow, or plain 2432-byte frames and messages 31. The input is
// hostile, so every length is bounded before it is used. The decoder keeps what is whole and lists
// the damage in the report. It never makes up a sweep and never returns half a radial.
//
// Units     Those of stormcellar/level2/volume.h; limits are in bytes.
// Threads   Pure functions. decode() may use `threads` threads of its own.
// Errors    empty: there are no bytes. not_level2: nothing was recognized. corrupt or truncated:
//           the input was recognized, but neither a whole radial nor metadata could be read.
//           unsupported: the input exceeds a limit on output, layers of compression or records.
//           exhausted: there is no more memory.
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

// Largest compressed content inside another compressed layer, such as LDM records inside gzip. The
// decoder holds it in memory as a whole. No known volume comes near this size.
inline constexpr std::size_t most_packed_bytes = std::size_t{64} << 20;

struct DecodeOptions {
    int threads = 1;
    // Limits the bytes of all decompressed messages. Memory holds only a few messages at a time.
    std::uint64_t output_limit_bytes = std::uint64_t{512} << 20;
    // Limits the arrays made from the messages; 0 means output_limit_bytes.
    std::uint64_t array_limit_bytes = 0;
    [[nodiscard]] std::uint64_t most_array_bytes() const {
        return array_limit_bytes == 0 ? output_limit_bytes : array_limit_bytes;
    }
    // Limits the open sweep of a growing volume; 0 means no separate limit. GrowingVolume checks
    // this limit after each record, and fails with over_budget beyond it.
    std::uint64_t open_sweep_limit_bytes = 0;
    // Arrays are made only for these moments and cuts. A cut that is not selected gives no sweep.
    Selection selection;
    // The station to use if the file does not name it, e.g. from the file name; empty: unknown.
    std::string fallback_station;
};

[[nodiscard]] Result<Decoded> decode(std::span<const std::byte> bytes,
                                     const DecodeOptions& options = {});

// Reads and decodes a file. If the content does not name the station, the first four characters of
// the file name give it, provided that the station table has them. Error messages begin with the
// path. Errors: as for read_file() and decode().
[[nodiscard]] Result<Decoded> decode_file(const std::filesystem::path& path,
                                          const DecodeOptions& options = {});

// Splits a decoded file into its volumes; an ordinary file has one. Each volume has its own sweeps
// and pattern, and a copy of the volume block. A further volume has its own header if the file
// holds one. Otherwise it gets a copy of the first header with the time of its own first radial,
// because the start time names a volume.
[[nodiscard]] std::vector<Volume> split_volumes(Decoded decoded);

}  // namespace stormcellar::level2
