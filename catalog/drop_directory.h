// catalog/drop_directory.h -- records the directory into which raw files are dropped, for readers
// of the catalog. Used only inside the catalog room.
//
// CATALOG/drop-directory holds the absolute path and a newline. The file is replaced in one step.
//
// Threads   Functions without state.
#pragma once

#include <filesystem>

#include "stormcellar/base/result.h"

namespace stormcellar::catalog {

// Writes the file if its contents differ. Errors: those of stormcellar/base/file_system.h.
[[nodiscard]] Status write_drop_directory(const std::filesystem::path& catalog,
                                          const std::filesystem::path& drop);
// Reads the file. Errors: not_found if there is no file; corrupt if the file does not hold an
// absolute path.
[[nodiscard]] Result<std::filesystem::path> read_drop_directory(
    const std::filesystem::path& catalog);

}  // namespace stormcellar::catalog
