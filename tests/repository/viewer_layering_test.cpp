// Tests that the folders of the viewer's source import one way, as C++ rooms do
// (layering_test.cpp).
#include <algorithm>
#include <filesystem>
#include <regex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/repository/text_of.h"
#include "tests/testing/data.h"

namespace stormcellar {
namespace {

namespace fs = std::filesystem;
using Folders = std::set<std::string>;

// Each folder with the folders that it may import. A folder comes after all folders that it
// imports. Besides, main.ts and tests may import everything, and every file may import facts.ts.
const std::vector<std::pair<std::string, Folders>> order = {
    {"wire", {}},
    {"camera", {}},
    {"time", {}},
    {"earth", {"wire"}},
    {"tables", {"wire"}},
    {"fields", {"camera", "earth", "wire"}},
    {"map", {"earth", "wire"}},
    {"overlay", {"camera", "earth"}},
    {"atlas", {"camera", "earth", "fields", "wire"}},
    {"scene", {"camera", "earth", "fields", "tables", "wire"}},
    {"renderer", {"atlas", "camera", "earth", "fields", "scene", "tables", "wire"}},
    {"page",
     {"atlas", "camera", "earth", "fields", "map", "renderer", "scene", "tables", "time", "wire"}},
    {"page/panels",
     {"atlas", "camera", "earth", "fields", "overlay", "page", "renderer", "scene", "tables",
      "time", "wire"}},
    {"page/start", {"earth", "map", "page", "renderer", "scene", "time", "wire"}},
};

// Returns the folders of the modules that a file imports by relative paths.
Folders imported_folders(const std::string& text, const fs::path& folder) {
    static const std::regex import(R"(\b(from|import)\s*\(?\s*'(\.[^']*)')");
    Folders found;
    for (auto match = std::sregex_iterator(text.begin(), text.end(), import);
         match != std::sregex_iterator(); ++match) {
        const fs::path module = (folder / (*match)[2].str()).lexically_normal();
        if (module != "facts") found.insert(module.parent_path().string());
    }
    return found;
}

TEST(ViewerLayering, FoldersImportOneWay) {
    const fs::path root = testing::source_directory() / "viewer" / "src";
    std::size_t files = 0;
    for (const auto& entry : fs::recursive_directory_iterator(root)) {
        if (entry.path().extension() != ".ts" || testing::is_viewer_test(entry.path())) continue;
        const fs::path file = fs::relative(entry.path(), root);
        const std::string own = file.parent_path().string();
        if (own.empty()) continue;
        ++files;
        const auto known = std::ranges::find(order, own, &decltype(order)::value_type::first);
        ASSERT_NE(known, order.end()) << own << " is not in the list of folders";
        for (const std::string& other : imported_folders(testing::text_of(entry.path()), own)) {
            EXPECT_TRUE(other == own || known->second.contains(other))
                << file << " imports from " << other;
        }
    }
    EXPECT_GE(files, 100U);
}

TEST(ViewerLayering, TheListHasAnOrder) {
    Folders before;
    for (const auto& [folder, may] : order) {
        for (const std::string& other : may)
            EXPECT_TRUE(before.contains(other)) << folder << " imports " << other;
        before.insert(folder);
    }
}

TEST(ViewerLayering, SeesImportsInEveryForm) {
    const std::string text =
        "import { a } from '../wire/api';\n"
        "import type { B } from './b';\n"
        "export { c } from '../../scene/c';\n"
        "const d = await import('../start/d');\n"
        "import fs from 'node:fs';\n";
    EXPECT_EQ(imported_folders(text, "page/panels"),
              (Folders{"page/wire", "page/panels", "scene", "page/start"}));
}

}  // namespace
}  // namespace stormcellar
