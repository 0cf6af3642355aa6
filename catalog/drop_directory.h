// catalog/drop_directory.h -- the drop directory, as a writer of the catalog noted it for readers.
//
// CATALOG/drop-directory holds the absolute path and a newline. The file appears whole. Inside the
// catalog room only. Thread contract: functions without state.
#pragma once

#include <filesystem>

#include "stormcellar/base/result.h"

namespace stormcellar::catalog {

// Writes the path if the file says something else. Errors: those of stormcellar/base/file_system.h.
[[nodiscard]] Status write_drop_directory(const std::filesystem::path& catalog,
                                          const std::filesystem::path& drop);
// Errors: not_found if nobody noted it; corrupt if it is not an absolute path.
[[nodiscard]] Result<std::filesystem::path> read_drop_directory(
    const std::filesystem::path& catalog);

}  // namespace stormcellar::catalog
