// pipeline/drop/drop_names.h -- decides by their names which files in the drop directory to ingest.
//
// A writer hides an unfinished file by a leading dot (pqact's dot-file, rsync, our own temporary
// files) or by an ending. Such files are ignored until they are renamed. Everything else in a name
// is only a first guess: the content decides.
//
// Threads   Pure functions.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace stormcellar::pipeline {

// Returns true for the last part of a path that begins with '.', ends with '~', or ends in .tmp,
// .temp, .part, .partial or .filepart (in lower case, as programs write them).
[[nodiscard]] bool is_temporary_name(std::string_view name);

// Returns the station with which the file's name begins, if the station table has it; else empty.
[[nodiscard]] std::string station_of_file_name(const std::filesystem::path& path);
// Returns the same station; else the station of its directory's name, else that of the directory
// above.
[[nodiscard]] std::string station_of_path(const std::filesystem::path& path);
// Returns true if the name is that of one chunk of a volume.
[[nodiscard]] bool is_chunk_name(const std::filesystem::path& path);

}  // namespace stormcellar::pipeline
