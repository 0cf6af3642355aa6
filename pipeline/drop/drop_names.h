// pipeline/drop/drop_names.h -- which names in the drop directory belong to files to take.
//
// A writer that is not done hides its file by a dot in front (pqact's dot-file, rsync, our own
// temporary files) or by an ending. Such files are ignored until they are renamed. Anything else
// that a name says is a first guess: the content decides.
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
// Returns the same; else the station of its directory's name, else that of the directory above.
[[nodiscard]] std::string station_of_path(const std::filesystem::path& path);
// Returns true if the name is that of one chunk of a volume.
[[nodiscard]] bool is_chunk_name(const std::filesystem::path& path);

}  // namespace stormcellar::pipeline
