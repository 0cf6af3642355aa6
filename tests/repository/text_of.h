// tests/repository/text_of.h -- finds files of the tree, reads them, and searches their texts.
#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/testing/data.h"

namespace stormcellar::testing {

// Returns the contents of a file. A test fails if it cannot be read.
[[nodiscard]] inline std::string text_of(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    EXPECT_TRUE(file) << path;
    return {std::istreambuf_iterator<char>(file), {}};
}

// Returns the text of the first group for each match of the expression.
[[nodiscard]] inline std::vector<std::string> found_in(const std::string& text,
                                                       const std::regex& what) {
    std::vector<std::string> found;
    for (std::sregex_iterator at(text.begin(), text.end(), what), end; at != end; ++at)
        found.push_back((*at)[1]);
    return found;
}

[[nodiscard]] inline std::string without_comments(const std::string& text) {
    std::istringstream lines(text);
    std::string code;
    for (std::string line; std::getline(lines, line);)
        code += line.substr(0, line.find("//")) + '\n';
    return code;
}

// Returns the files below a folder, without the files that npm installs.
[[nodiscard]] inline std::vector<std::filesystem::path> files_below(
    const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files;
    for (std::filesystem::recursive_directory_iterator entry(folder), end; entry != end; ++entry) {
        if (entry->path().filename() == "node_modules") entry.disable_recursion_pending();
        if (entry->is_regular_file()) files.push_back(entry->path());
    }
    return files;
}

// Returns the C++ headers and sources below a folder.
[[nodiscard]] inline std::vector<std::filesystem::path> sources_below(
    const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> sources = files_below(folder);
    std::erase_if(sources, [](const std::filesystem::path& path) {
        return path.extension() != ".h" && path.extension() != ".cpp";
    });
    return sources;
}

// Returns the folders of the root with the product, its benchmarks and its documents: all folders
// except tests, builds and hidden folders.
[[nodiscard]] inline std::vector<std::filesystem::path> folders_of_the_product() {
    std::vector<std::filesystem::path> folders;
    for (const auto& entry : std::filesystem::directory_iterator(source_directory())) {
        const std::string name = entry.path().filename();
        const bool is_other =
            name.starts_with('.') || name.starts_with("build") || name == "tests" || name == "out";
        if (entry.is_directory() && !is_other) folders.push_back(entry.path());
    }
    return folders;
}

// Returns true for the unit tests of the viewer, which are beside its sources, and for the code
// that they share.
[[nodiscard]] inline bool is_viewer_test(const std::filesystem::path& path) {
    return path.string().ends_with(".test.ts") || path.parent_path().filename() == "testing";
}

}  // namespace stormcellar::testing
