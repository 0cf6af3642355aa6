// tests/level2/joined_files.h -- joins the chunks of a volume.
#pragma once

#include <filesystem>
#include <set>
#include <vector>

#include "stormcellar/base/file_system.h"

namespace stormcellar::level2 {

// Returns the bytes of all files in a folder, in the order of their names.
[[nodiscard]] inline std::vector<std::byte> joined_files(const std::filesystem::path& folder) {
    std::set<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        files.insert(entry.path());
    std::vector<std::byte> joined;
    for (const auto& file : files) {
        const auto bytes = read_file(file).value();
        joined.insert(joined.end(), bytes.begin(), bytes.end());
    }
    return joined;
}

}  // namespace stormcellar::level2
