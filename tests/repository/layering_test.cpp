// Data flows one way: a room may include itself and the rooms named for it (docs/architecture.md).
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/testing/data.h"

namespace stormcellar {
namespace {

namespace fs = std::filesystem;
using Rooms = std::set<std::string>;

const std::map<std::string, Rooms> allowed = {
    {"base", {}},
    {"accuracy", {"base"}},
    {"bunzip", {}},
    {"archive", {"base"}},
    {"fetch", {"base"}},
    {"level2", {"base", "bunzip"}},
    {"catalog", {"archive", "base", "level2"}},
    {"grid", {"base", "accuracy", "level2"}},
    {"cache", {"base", "grid", "level2"}},
    {"render", {"base", "accuracy", "grid", "cache", "level2"}},
    {"synth", {"archive", "base", "level2", "grid"}},
    {"export", {"base", "level2", "grid"}},
    {"pipeline", {"base", "accuracy", "archive", "level2", "catalog", "grid", "cache"}},
    {"daemon",
     {"base", "accuracy", "archive", "bunzip", "level2", "catalog", "grid", "cache", "pipeline"}},
    {"cli",
     {"base", "accuracy", "archive", "bunzip", "fetch", "level2", "catalog", "grid", "cache",
      "render", "synth", "export", "pipeline"}},
};

// The rooms that a source text includes, by its quoted includes.
Rooms included_rooms(const std::string& text) {
    static const std::regex include(R"re((?:^|\n)\s*#\s*include\s*"([^"/]+)/)re");
    Rooms rooms;
    for (auto match = std::sregex_iterator(text.begin(), text.end(), include);
         match != std::sregex_iterator(); ++match) {
        rooms.insert((*match)[1]);
    }
    return rooms;
}

std::string read(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<fs::path> sources_of(const fs::path& room) {
    std::vector<fs::path> sources;
    for (const auto& entry : fs::recursive_directory_iterator(room)) {
        const auto ending = entry.path().extension();
        if (ending == ".h" || ending == ".cpp") sources.push_back(entry.path());
    }
    return sources;
}

// What is wrong with one room's includes; empty when nothing is.
std::vector<std::string> violations(const fs::path& room, const Rooms& may) {
    std::vector<std::string> found;
    for (const auto& source : sources_of(room)) {
        for (const auto& included : included_rooms(read(source))) {
            if (included != room.filename() && !may.contains(included)) {
                found.push_back(source.string() + " includes " + included);
            }
        }
    }
    return found;
}

class Layering : public ::testing::TestWithParam<std::pair<const std::string, Rooms>> {};

TEST_P(Layering, IncludesOnlyWhatItMay) {
    const auto& [room, may] = GetParam();
    const fs::path directory = testing::source_directory() / room;
    if (!fs::exists(directory)) GTEST_SKIP() << "the room " << room << " is not built yet";
    for (const auto& violation : violations(directory, may))
        ADD_FAILURE() << violation;
}

INSTANTIATE_TEST_SUITE_P(Rooms, Layering, ::testing::ValuesIn(allowed),
                         [](const auto& instance) { return instance.param.first; });

TEST(LayeringCheck, SeesIncludesInEveryForm) {
    EXPECT_EQ(included_rooms("#include \"render/image.h\"\n  # include \"grid/grid.h\"\n"),
              (Rooms{"render", "grid"}));
    EXPECT_EQ(included_rooms("// says \"render/image.h\"\n#include <vector>\n"), Rooms{});
}

// Every folder with C++ in it is a room of the list, or one of the three that may use all.
TEST(LayeringCheck, KnowsEveryRoom) {
    const Rooms free = {"tests", "bench", "build", "out"};
    for (const auto& entry : fs::directory_iterator(testing::source_directory())) {
        const std::string name = entry.path().filename();
        if (!entry.is_directory() || name.starts_with(".") || free.contains(name)) continue;
        if (!sources_of(entry.path()).empty()) {
            EXPECT_TRUE(allowed.contains(name)) << name << " is no room of the design";
        }
    }
}

}  // namespace
}  // namespace stormcellar
