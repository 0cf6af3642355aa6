// stormcellar/level2/chunk_directory.h -- decodes a directory that holds the chunks of one volume.
//
// Threads   Pure functions, which read files.
// Errors    See each function. Messages begin with the path.
#pragma once

#include <filesystem>

#include "stormcellar/level2/decode.h"

namespace stormcellar::level2 {

// Decodes the files that have names of chunks (chunk_name.h), in the order of their numbers, and
// passes over all other files. A number without a file, and a file that holds nothing whole, become
// problems of the report. If the chunks do not name the station, the name of the directory or of
// its parent does. Errors: not_found if there is no directory, or no chunk in it; bad_argument for
// chunks of several volumes; permission and io from the file system; those of decode().
[[nodiscard]] Result<Decoded> decode_chunk_directory(const std::filesystem::path& directory,
                                                     const DecodeOptions& options = {});

// Decodes a file, or a directory of chunks. Errors: those of decode_file() and
// decode_chunk_directory().
[[nodiscard]] Result<Decoded> decode_path(const std::filesystem::path& path,
                                          const DecodeOptions& options = {});

}  // namespace stormcellar::level2
