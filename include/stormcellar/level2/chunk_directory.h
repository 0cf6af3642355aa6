// stormcellar/level2/chunk_directory.h -- decodes a volume whose chunks are files in one directory.
//
// The public bucket reuses the numbers of volumes after 999, so a directory may hold chunks of
// older volumes beside the newest volume.
//
// Threads   The functions read files and keep no state.
// Errors    See each function. Messages begin with the path.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "stormcellar/level2/decode.h"

namespace stormcellar::level2 {

// The chunk files of one volume (chunk_name.h), in the order of their numbers.
struct ChunkSet {
    std::string volume;  // from the names: "20220317-000842"
    std::vector<std::filesystem::path> chunks;
};
// Returns the volumes that have chunks in the directory, the oldest first, and ignores other files.
// Errors: not_found if there is no directory, or no chunk in it; permission and io from the file
// system.
[[nodiscard]] Result<std::vector<ChunkSet>> chunk_sets(const std::filesystem::path& directory);

// Decodes the chunks of one volume. The report lists missing chunk numbers, and files that hold
// nothing whole, as problems. If neither the chunks nor `options` name the station, the name of the
// directory or of its parent gives it. Errors: empty if `chunks` is empty; bad_argument for a file
// that is not named as a chunk, or that belongs to another volume; the errors of read_file() and
// decode().
[[nodiscard]] Result<Decoded> decode_chunks(const std::vector<std::filesystem::path>& chunks,
                                            const DecodeOptions& options = {});

// Decodes the chunks of the newest volume in the directory. Errors: as for chunk_sets() and
// decode_chunks().
[[nodiscard]] Result<Decoded> decode_chunk_directory(const std::filesystem::path& directory,
                                                     const DecodeOptions& options = {});

// Decodes a file, or a directory of chunks. Errors: as for decode_file() and
// decode_chunk_directory().
[[nodiscard]] Result<Decoded> decode_path(const std::filesystem::path& path,
                                          const DecodeOptions& options = {});

}  // namespace stormcellar::level2
