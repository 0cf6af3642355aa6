// pipeline/drop/read_whole.h -- reads and decodes a raw file that does not grow. Used only inside
// the pipeline room.
//
// A file of ordinary size is read into memory and then decoded by several threads. A large file is
// decoded stretch by stretch while it is read, so that a large file needs no more memory. Both
// methods give the same volume, bit for bit, except for files that
// stormcellar/level2/growing_volume.h refuses.
//
// Threads   A function without state.
#pragma once

#include <cstdint>
#include <filesystem>

#include "stormcellar/base/result.h"
#include "stormcellar/level2/decode.h"

namespace stormcellar::pipeline {

// A file above this size counts as large. The largest known volume has 12 MB, or 75 MB
// uncompressed.
inline constexpr std::uint64_t large_file_bytes = std::uint64_t{32} << 20;

struct WholeFile {
    // The result of reading. Errors: those of base/beneath.h; io if fewer than `size_bytes` bytes
    // come.
    Status was_read;
    std::uint64_t content_hash = 0;
    // The result of decoding the bytes that were read. Errors: those of level2::decode().
    Result<level2::Decoded> decoded = fail(ErrorCode::empty, "nothing was read");
    double read_s = 0, decode_s = 0;
};

[[nodiscard]] WholeFile read_whole(const std::filesystem::path& beneath,
                                   const std::filesystem::path& path, std::uint64_t size_bytes,
                                   const level2::DecodeOptions& options);

}  // namespace stormcellar::pipeline
