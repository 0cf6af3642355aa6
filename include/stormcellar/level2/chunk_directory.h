// stormcellar/level2/chunk_directory.h -- decodes the chunks of a volume that are files of one
// directory.
//
// The public bucket reuses the numbers of volumes after 999, so a directory may hold chunks of an
// older volume beside those of the newest.
//
// Threads   Pure functions, which read files.
// Errors    See each function. Messages begin with the path.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "stormcellar/level2/decode.h"

namespace stormcellar::level2 {

// The files that have names of chunks of one volume (chunk_name.h), in the order of their numbers.
struct ChunkSet {
    std::string volume;  // from the names: "20220317-000842"
    std::vector<std::filesystem::path> chunks;
};
// Returns the volumes that have chunks in the directory, the oldest first. Other files are ignored.
// Errors: not_found if there is no directory, or no chunk in it; permission and io from the file
// system.
[[nodiscard]] Result<std::vector<ChunkSet>> chunk_sets(const std::filesystem::path& directory);

// Decodes chunks of one volume. The report lists each number without a file, and each file that
// holds nothing whole, as a problem. If the chunks do not name the station, the name of their
// directory or of its parent does. Errors name the directory: bad_argument for a chunk of another
// volume; permission and io from the file system; those of decode().
[[nodiscard]] Result<Decoded> decode_chunks(const std::vector<std::filesystem::path>& chunks,
                                            const DecodeOptions& options = {});

// Decodes the chunks of the newest volume in the directory. Errors: those of chunk_sets() and
// decode_chunks().
[[nodiscard]] Result<Decoded> decode_chunk_directory(const std::filesystem::path& directory,
                                                     const DecodeOptions& options = {});

// Decodes a file, or a directory of chunks. Errors: those of decode_file() and
// decode_chunk_directory().
[[nodiscard]] Result<Decoded> decode_path(const std::filesystem::path& path,
                                          const DecodeOptions& options = {});

}  // namespace stormcellar::level2
