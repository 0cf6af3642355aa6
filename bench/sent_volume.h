// bench/sent_volume.h -- a real volume that is sent to the daemon record by record.
//
// Threads   Pure functions, but for the file that append_piece() writes.
#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "bench/measure.h"
#include "stormcellar/base/result.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::bench {

struct SentPieces {
    std::filesystem::path path;
    Bytes bytes;
    level2::Volume decoded;
};

// Errors: those of reading and decoding; unsupported for a file without LDM records.
[[nodiscard]] Result<SentPieces> read_sent_volume(const std::filesystem::path& path);

// "20220317-000842-001-S": the name of a chunk. The first is number 1.
[[nodiscard]] std::string chunk_name(const SentPieces& volume, std::size_t number, bool is_last);

// Appends the bytes to the file and returns the time just before its close.
std::chrono::steady_clock::time_point append_piece(const std::filesystem::path& path,
                                                   std::span<const std::byte> bytes);

// Returns the seconds that bunzip alone takes for a piece: the least of three runs.
[[nodiscard]] double bzip2_of(std::span<const std::byte> piece);

}  // namespace stormcellar::bench
