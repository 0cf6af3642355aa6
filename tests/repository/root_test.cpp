// Checks the root of the tree, because a stray file there is the first thing that a visitor sees.
// 2026-11-28: a picture named --colors was in the root for days.
#include <algorithm>
#include <array>
#include <filesystem>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "tests/repository/text_of.h"
#include "tests/testing/data.h"

namespace stormcellar {
namespace {

namespace fs = std::filesystem;

constexpr std::array root_documents = {"CHANGELOG.md",      "CITATION.cff",    "CMakeLists.txt",
                                       "CMakePresets.json", "CONTRIBUTING.md", "GLOSSARY.md",
                                       "LICENSE",           "README.md",       "SECURITY.md"};
constexpr std::array hidden_names = {".ci", ".clang-format", ".clang-tidy", ".git", ".gitignore"};
// Folders without a CMakeLists.txt.
constexpr std::array other_folders = {"cmake", "docs", "include", "python", "scenes", "scripts"};

bool is_one_of(const auto& names, const std::string& name) {
    return std::ranges::find(names, name) != names.end();
}

// Returns true for names in the root that git ignores: /build/, /demo-output/ and the like.
bool is_ignored(const std::string& name) {
    std::istringstream lines(testing::text_of(testing::source_directory() / ".gitignore"));
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with('/')) line.erase(0, 1);
        if (line.ends_with('/')) line.pop_back();
        const bool any_end = line.ends_with('*');
        if (any_end ? name.starts_with(line.substr(0, line.size() - 1)) : name == line) return true;
    }
    return false;
}

TEST(Root, HoldsRoomsAndKnownDocumentsAlone) {
    const fs::path root = testing::source_directory();
    for (const auto& entry : fs::directory_iterator(root)) {
        const std::string name = entry.path().filename();
        const bool is_room = entry.is_directory() && fs::exists(entry.path() / "CMakeLists.txt");
        EXPECT_TRUE(is_room || is_one_of(root_documents, name) || is_one_of(hidden_names, name) ||
                    is_one_of(other_folders, name) || is_ignored(name))
            << name << " is in the root of the tree";
    }
}

}  // namespace
}  // namespace stormcellar
