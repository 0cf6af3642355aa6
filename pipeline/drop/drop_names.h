// pipeline/drop/drop_names.h -- which names in the drop directory are files to ingest.
//
// A writer that has not finished hides its file behind a dot in front (pqact's dot-file, rsync, our
// own temporary files) or behind an ending. The service leaves such names alone until they are
// renamed. Everything else that a name tells is a first guess: the contents decide.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace stormcellar::pipeline {

// True for the last part of a path that begins with '.', ends with '~', or ends in .tmp, .temp,
// .part, .partial or .filepart (lower case, as programs write them).
[[nodiscard]] bool is_temporary_name(std::string_view name);

// The station that the file's name begins with, if it is in the station table; otherwise empty.
[[nodiscard]] std::string station_of_file_name(const std::filesystem::path& path);
// The same. If the file's name has no station, that of the name of its directory, then of the
// directory above.
[[nodiscard]] std::string station_of_path(const std::filesystem::path& path);
// Returns true if the name is that of one chunk of a volume.
[[nodiscard]] bool is_chunk_name(const std::filesystem::path& path);

}  // namespace stormcellar::pipeline
