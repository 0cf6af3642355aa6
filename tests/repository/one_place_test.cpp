// Tests that options of a picture, subcommands and formats are each listed in one place. A second
// list fails the test.
#include <algorithm>
#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/repository/text_of.h"
#include "tests/testing/data.h"

namespace stormcellar {
namespace {

namespace fs = std::filesystem;

// Returns the code of the rooms that have such a table, by the paths of the sources.
const std::map<std::string, std::string>& code_by_path() {
    static const auto all = [] {
        const fs::path root = testing::source_directory();
        std::map<std::string, std::string> code;
        for (const char* room : {"cli", "daemon", "export", "pipeline", "render"}) {
            for (const fs::path& path : testing::sources_below(root / room))
                code[fs::relative(path, root)] = testing::without_comments(testing::text_of(path));
        }
        return code;
    }();
    return all;
}

// Returns the sources below these folders whose code contains a text.
std::set<std::string> sources_with(const std::string& text, const std::vector<std::string>& below) {
    std::set<std::string> found;
    for (const auto& [path, code] : code_by_path()) {
        const bool is_below = std::ranges::any_of(below, [&path = path](const std::string& folder) {
            return path.starts_with(folder + "/");
        });
        if (is_below && code.find(text) != std::string::npos) found.insert(path);
    }
    return found;
}

std::string quoted(const std::string& text) {
    return '"' + text + '"';
}

const std::set<std::string> option_table{"render/options/picture_option_rows.cpp"};
const std::set<std::string> subcommand_registry{"cli/subcommands.cpp"};

TEST(OnePlace, AnOptionOfAPictureIsNamedInTheTableAlone) {
    const std::string table = testing::text_of(testing::source_directory() / *option_table.begin());
    const auto options = testing::found_in(table, std::regex(R"re(option = "(--[a-z-]+)")re"));
    ASSERT_GE(options.size(), 29U);
    const std::set<std::string> distinct(options.begin(), options.end());
    EXPECT_EQ(distinct.size(), options.size()) << "each option has one row";
    for (const std::string& option : options) {
        EXPECT_EQ(sources_with(quoted(option), {"cli/picture", "cli/loop", "render/options"}),
                  option_table)
            << option;
    }
}

TEST(OnePlace, AKeyOfASceneFileIsNamedInTheTableAlone) {
    const std::string table = testing::text_of(testing::source_directory() / *option_table.begin());
    const auto keys = testing::found_in(table, std::regex(R"re(key = "([a-z_]+)")re"));
    ASSERT_GE(keys.size(), 28U);
    // These words are also keys of a picture's metadata and JSON.
    const std::set<std::string> also_facts{"product", "moment",      "width",        "height",
                                           "frames",  "azimuth_deg", "elevation_deg"};
    for (const std::string& key : keys) {
        if (also_facts.contains(key)) continue;
        EXPECT_EQ(sources_with(quoted(key), {"cli/picture", "cli/loop", "render/options"}),
                  option_table)
            << key;
    }
}

TEST(OnePlace, ASubcommandIsRegisteredOnce) {
    const std::string registry =
        testing::text_of(testing::source_directory() / *subcommand_registry.begin());
    const auto names = testing::found_in(registry, std::regex(R"re(Subcommand\{"([a-z]+)")re"));
    ASSERT_GE(names.size(), 11U);
    EXPECT_TRUE(std::ranges::is_sorted(names)) << "--help shows the names in this order";
    for (const std::string& name : names) {
        const std::string function = "set_up_" + name + "(";
        const auto sources = sources_with(function, {"cli"});
        EXPECT_EQ(sources.size(), 2U)
            << function << ": only its own file and the registry may have its name";
        EXPECT_TRUE(sources.contains(*subcommand_registry.begin())) << function;
    }
    EXPECT_EQ(sources_with("add_subcommand(app,", {"cli"}), std::set<std::string>{"cli/main.cpp"})
        << "a subcommand comes from the registry";
}

TEST(OnePlace, AnEndingOfALoopOrOfAGridIsInItsRegistryAlone) {
    // ".webp" is left out: cli/loop/loop.cpp uses it for standard output.
    for (const char* ending : {".gif", ".apng", ".mp4", ".webm"}) {
        EXPECT_EQ(sources_with(quoted(ending), {"cli", "daemon", "pipeline", "render"}),
                  std::set<std::string>{"render/animation/animation.cpp"})
            << ending;
    }
    EXPECT_EQ(sources_with(quoted(".nc"), {"cli/grid", "export"}),
              (std::set<std::string>{"export/grid_format.cpp", "export/volume_format.cpp"}));
}

}  // namespace
}  // namespace stormcellar
