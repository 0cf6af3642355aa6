// tests/repository/text_of.h -- files of the tree, and a file as one text.
#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace stormcellar::testing {

// Returns the contents of a file. A test fails if it cannot be read.
[[nodiscard]] inline std::string text_of(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    EXPECT_TRUE(file) << path;
    return {std::istreambuf_iterator<char>(file), {}};
}

// Returns the files below a folder, without those that npm installs.
[[nodiscard]] inline std::vector<std::filesystem::path> files_below(
    const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files;
    for (std::filesystem::recursive_directory_iterator entry(folder), end; entry != end; ++entry) {
        if (entry->path().filename() == "node_modules") entry.disable_recursion_pending();
        if (entry->is_regular_file()) files.push_back(entry->path());
    }
    return files;
}

// Returns true for the unit tests of the viewer, which stand beside its sources, and for what they
// share.
[[nodiscard]] inline bool is_viewer_test(const std::filesystem::path& path) {
    return path.string().ends_with(".test.ts") || path.parent_path().filename() == "testing";
}

}  // namespace stormcellar::testing
