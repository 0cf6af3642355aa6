// pipeline/drop/drop_names.h -- which names in the drop directory are files to take.
//
// A writer that is not done hides its file: a dot in front (pqact's dot-file, rsync, our own
// temporary files) or an ending that says so. Such names are left alone until they are renamed.
// What else a name says is a first guess: content decides.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace stormcellar::pipeline {

// True for the last part of a path that begins with '.', ends with '~', or ends in .tmp, .temp,
// .part, .partial or .filepart (lower case, as programs write them).
[[nodiscard]] bool is_temporary_name(std::string_view name);

// The station that the file's name begins with, when it is one of the table; else empty.
[[nodiscard]] std::string station_of_file_name(const std::filesystem::path& path);
// The same; else that of its directory's name, else of the one above.
[[nodiscard]] std::string station_of_path(const std::filesystem::path& path);
// Whether the name is that of one chunk of a volume.
[[nodiscard]] bool is_chunk_name(const std::filesystem::path& path);

}  // namespace stormcellar::pipeline
