// pipeline/drop/drop_names.h -- tells from the name of a file in the drop directory whether the
// file is unfinished, whether it is a chunk, and of which station it is.
//
// A writer marks an unfinished file with a leading dot (pqact's dot-file, rsync, our own temporary
// files) or with an ending. Such files are ignored until they are renamed. The station in a name is
// only a first guess; the contents decide.
//
// Threads   Pure functions.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace stormcellar::pipeline {

// Returns true if the last part of a path, `name`, is empty, begins with '.', or ends in ~, .tmp,
// .temp, .part, .partial or .filepart (only in lower case).
[[nodiscard]] bool is_temporary_name(std::string_view name);

// Returns the station in the file's name (station_in_name()), or an empty text.
[[nodiscard]] std::string station_of_file_name(const std::filesystem::path& path);
// Returns the station in the file's name, else the station in the name of its directory, else the
// station in the name of the directory above. Returns an empty text if none of these names has a
// station.
[[nodiscard]] std::string station_of_path(const std::filesystem::path& path);
// Returns true if the file's name is the name of a chunk.
[[nodiscard]] bool is_chunk_name(const std::filesystem::path& path);

}  // namespace stormcellar::pipeline
