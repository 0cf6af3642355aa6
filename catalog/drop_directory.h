// catalog/drop_directory.h -- the directory that raw files are dropped into, as a writer of the
// catalog wrote it down for its readers.
//
// CATALOG/drop-directory holds the path, which is absolute, and a newline. It appears whole.
// Inside the catalog room only. Thread contract: functions without state.
#pragma once

#include <filesystem>

#include "stormcellar/base/result.h"

namespace stormcellar::catalog {

// Writes it where it says something else. Errors: those of stormcellar/base/file_system.h.
[[nodiscard]] Status write_drop_directory(const std::filesystem::path& catalog,
                                          const std::filesystem::path& drop);
// not_found where nobody wrote it down; corrupt where it is no absolute path.
[[nodiscard]] Result<std::filesystem::path> read_drop_directory(
    const std::filesystem::path& catalog);

}  // namespace stormcellar::catalog
