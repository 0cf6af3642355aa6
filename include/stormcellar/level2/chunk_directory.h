// stormcellar/level2/chunk_directory.h -- a directory that holds the chunks of one volume.
#pragma once

#include <filesystem>

#include "stormcellar/level2/decode.h"

namespace stormcellar::level2 {

// Decodes the files that have chunks' names (chunk_name.h), in the order of their numbers; other
// files are not looked at. Numbers of which there is no file, and files that hold nothing whole,
// are problems of the report. The station falls back to the name of the directory or the one above.
// Errors: not_found for no directory or one without chunks; bad_argument for chunks of several
// volumes; those of decode(). Messages begin with the path.
[[nodiscard]] Result<Decoded> decode_chunk_directory(const std::filesystem::path& directory,
                                                     const DecodeOptions& options = {});

// A file, or a directory of chunks.
[[nodiscard]] Result<Decoded> decode_path(const std::filesystem::path& path,
                                          const DecodeOptions& options = {});

}  // namespace stormcellar::level2
