// Tests that includes run one way: a room includes only itself and the rooms allowed for it
// (docs/architecture.md). An inner room includes only itself and the inner rooms allowed for it. A
// public header, include/stormcellar/ROOM/NAME.h, counts as part of the inner room of NAME.cpp, and
// includes only public headers.
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
using Rooms = std::set<std::string>;

const std::map<std::string, Rooms> allowed = {
    {"base", {}},
    {"service", {"base"}},
    {"accuracy", {"base"}},
    {"bunzip", {}},
    {"archive", {"base"}},
    {"fetch", {"base", "cache", "grid", "level2", "service"}},
    {"notify", {"base", "cache", "fetch/pull", "grid", "level2", "retrieve", "service"}},
    {"arrayfile", {"base"}},
    {"level2", {"arrayfile", "base", "bunzip"}},
    {"catalog", {"archive", "base", "level2"}},
    {"grid", {"base", "accuracy", "level2"}},
    {"retrieve", {"base", "accuracy", "grid", "level2"}},
    {"capi",
     {"base", "accuracy", "archive", "level2", "catalog", "grid", "cache", "pipeline", "render",
      "retrieve"}},
    {"cache", {"base", "grid", "level2"}},
    {"render", {"base", "accuracy", "export", "grid", "cache", "level2", "retrieve"}},
    {"synth", {"accuracy", "archive", "base", "level2", "grid"}},
    {"export", {"base", "level2", "grid", "retrieve"}},
    {"pipeline", {"base", "accuracy", "archive", "level2", "catalog", "grid", "cache", "retrieve"}},
    {"batch",
     {"archive", "base", "cache", "catalog", "fetch", "grid", "level2", "pipeline", "retrieve"}},
    {"daemon",
     {"base", "accuracy", "archive", "bunzip", "level2", "catalog", "grid", "cache", "pipeline",
      "retrieve", "service", "web/config"}},
    {"web",
     {"base", "accuracy", "archive", "level2", "catalog", "grid", "cache", "render", "export",
      "pipeline", "retrieve", "service"}},
    {"cli",
     {"base", "accuracy", "archive", "batch", "bunzip", "fetch", "level2", "catalog", "grid",
      "cache", "render", "synth", "export", "pipeline", "retrieve", "service", "web"}},
};

// The inner rooms that each inner room may include besides itself, from the lowest up. Rooms
// without a row here have no inner rooms.
const std::map<std::string, std::map<std::string, Rooms>> allowed_inside = {
    {"level2",
     {{"volume", {}},
      {"messages", {"volume"}},
      {"containers", {"messages", "volume"}},
      {"foreign", {"volume"}},
      {"decode", {"containers", "foreign", "messages", "volume"}},
      {"live", {"containers", "decode", "volume"}},
      {"encode", {"containers", "decode", "messages", "volume"}}}},
    {"grid",
     {{"frame", {}},
      {"beam", {}},
      {"cells", {"beam", "frame"}},
      {"place", {"beam", "cells", "frame"}},
      {"sweep", {"beam", "cells", "frame", "place"}},
      {"fill", {"beam", "cells", "place", "sweep"}},
      {"mosaic", {"beam", "cells", "fill", "place", "sweep"}},
      {"plan", {"beam", "cells", "fill", "frame", "place", "sweep"}},
      {"judge", {"beam", "cells", "fill", "mosaic", "place", "sweep"}}}},
    {"render",
     {{"image", {}},
      {"color", {"image"}},
      {"view", {"color", "image"}},
      {"volume", {"color", "image", "view"}},
      {"products", {"color", "image", "view"}},
      {"wind", {"image", "view"}},
      {"overlay", {"image", "view"}},
      {"map", {"color", "image", "products", "view", "volume"}},
      {"plan", {"color", "image", "view", "volume"}},
      {"frame", {"image", "map", "products", "view", "volume"}},
      {"still", {"image", "color", "view", "products", "map", "frame"}},
      {"animation", {"image"}},
      {"options", {"animation", "color", "frame", "overlay", "still", "view"}}}},
    {"pipeline",
     {{"drop", {}},
      {"options", {}},
      {"keep", {"options"}},
      {"mosaic", {"keep", "options"}},
      {"plan", {"mosaic"}},
      {"ingest", {"drop", "keep", "mosaic", "options"}},
      {"care", {"drop", "ingest", "mosaic", "options"}}}},
    {"daemon",
     {{"config", {}},
      {"log", {}},
      {"process", {"log"}},
      {"watch", {"process"}},
      {"queue", {"config", "watch"}},
      {"status", {"config", "log", "process", "queue", "watch"}},
      {"loops", {"config", "log", "process", "queue", "status", "watch"}},
      {"care", {"log", "process", "queue", "status"}},
      {"partials", {"config", "log", "process", "status", "watch"}},
      {"service", {"care", "config", "log", "loops", "process", "queue", "status", "watch"}}}},
    {"fetch", {{"bucket", {}}, {"feed", {"bucket"}}, {"pull", {}}}},
    {"web",
     {{"config", {}},
      {"http", {}},
      {"data", {"http"}},
      {"doors", {"config", "data", "http"}},
      {"service", {"config", "data", "doors", "http"}}}},
    {"cli",
     {{"shared", {}},
      {"grid", {"shared"}},
      {"files", {"shared"}},
      {"query", {"files", "shared"}},
      {"picture", {"grid", "shared"}},
      {"loop", {"grid", "picture", "shared"}},
      {"batch", {"grid", "loop", "shared"}},
      {"accuracy", {"grid", "picture", "shared"}},
      {"synth", {"shared"}},
      {"storms", {"grid", "picture", "shared"}},
      {"velocity", {"shared"}},
      {"serve", {"grid", "shared"}},
      {"reference", {"shared"}}}},
};

// Inner rooms of the public headers that have no source of the same name.
const std::map<std::string, std::string> homes_of_headers = {
    {"grid/chosen", "beam"},
    {"grid/grid", "cells"},
    {"level2/decode_report", "volume"},
    {"level2/decoded", "volume"},
    {"level2/selection", "volume"},
    {"level2/fragment", "decode"},
    {"level2/sweep_depot", "decode"},
    {"render/frame_facts", "view"},
    {"render/integration", "view"},
    {"render/overlays", "view"},
};

// Returns the paths that a text includes in quotes, as they are written.
std::vector<fs::path> quoted_includes(const std::string& text) {
    static const std::regex include(R"re((?:^|\n)\s*#\s*include\s*"([^"]+/[^"]+)")re");
    const auto found = testing::found_in(text, include);
    return {found.begin(), found.end()};
}

// A path split at its room: "grid" and "fill/column.h" for grid/fill/column.h; "grid" and
// "gridder.h" for stormcellar/grid/gridder.h.
struct Place {
    std::string room;
    fs::path rest;
    bool is_public = false;
};
Place place_of(const fs::path& included) {
    auto part = included.begin();
    Place place;
    place.is_public = *part == "stormcellar";
    if (place.is_public) ++part;
    place.room = (part++)->string();
    for (; part != included.end(); ++part)
        place.rest /= *part;
    return place;
}

// Returns the rooms of a text's quoted includes.
Rooms included_rooms(const std::string& text) {
    Rooms rooms;
    for (const fs::path& included : quoted_includes(text))
        rooms.insert(place_of(included).room);
    return rooms;
}

// Returns the sources of a room and its public headers.
std::vector<fs::path> all_sources_of(const std::string& room) {
    std::vector<fs::path> sources = testing::sources_below(testing::source_directory() / room);
    const fs::path headers = testing::source_directory() / "include" / "stormcellar" / room;
    if (fs::exists(headers)) {
        for (fs::path& header : testing::sources_below(headers))
            sources.push_back(std::move(header));
    }
    return sources;
}

// Returns what is wrong with one room's includes; empty if nothing is.
std::vector<std::string> violations(const std::string& room, const Rooms& may) {
    std::vector<std::string> found;
    for (const auto& source : all_sources_of(room)) {
        for (const fs::path& included : quoted_includes(testing::text_of(source))) {
            const Place place = place_of(included);
            // A room may be allowed a single inner room of another room.
            const std::string inner = place.room + "/" + place.rest.begin()->string();
            if (place.room != room && !may.contains(place.room) && !may.contains(inner))
                found.push_back(source.string() + " includes " + included.string());
        }
    }
    return found;
}

// Returns the inner room of a file; empty for a file directly in its room, such as a main.cpp.
std::string inner_room_of(const Place& place) {
    if (place.rest.has_parent_path()) return place.rest.begin()->string();
    if (!place.is_public) return {};
    const std::string name = place.room + "/" + place.rest.stem().string();
    if (const auto home = homes_of_headers.find(name); home != homes_of_headers.end()) {
        return home->second;
    }
    for (const auto& [inner, may] : allowed_inside.at(place.room)) {
        fs::path source = testing::source_directory() / place.room / inner / place.rest;
        if (fs::exists(source.replace_extension(".cpp"))) return inner;
    }
    return "?";
}

class Layering : public ::testing::TestWithParam<std::pair<const std::string, Rooms>> {};

TEST_P(Layering, IncludesOnlyWhatItMay) {
    const auto& [room, may] = GetParam();
    for (const auto& violation : violations(room, may))
        ADD_FAILURE() << violation;
}

INSTANTIATE_TEST_SUITE_P(Rooms, Layering, ::testing::ValuesIn(allowed),
                         [](const auto& instance) { return instance.param.first; });

TEST_P(Layering, IncludesRunOneWayInsideToo) {
    const std::string room = GetParam().first;
    const auto inside = allowed_inside.find(room);
    if (inside == allowed_inside.end()) return;
    const fs::path root = testing::source_directory();
    for (const fs::path& source : all_sources_of(room)) {
        fs::path path = fs::relative(source, root);
        if (*path.begin() == "include") path = fs::relative(path, "include");
        const std::string own = inner_room_of(place_of(path));
        if (own.empty()) continue;
        ASSERT_TRUE(inside->second.contains(own)) << path << " is in no room of " << room;
        for (const fs::path& included : quoted_includes(testing::text_of(source))) {
            const Place place = place_of(included);
            if (place.room != room) continue;
            const std::string other = inner_room_of(place);
            EXPECT_TRUE(other == own || inside->second.at(own).contains(other))
                << path << " includes " << included << ", in " << other;
        }
    }
}

TEST_P(Layering, PublicHeadersIncludePublicOnes) {
    const fs::path headers =
        testing::source_directory() / "include" / "stormcellar" / GetParam().first;
    if (!fs::exists(headers)) return;
    for (const fs::path& header : testing::sources_below(headers)) {
        for (const fs::path& included : quoted_includes(testing::text_of(header)))
            EXPECT_TRUE(place_of(included).is_public) << header << " includes " << included;
    }
}

// Inner rooms do not include each other in a circle, because each comes before the rooms that
// include it.
TEST(LayeringCheck, RoomsInsideHaveAnOrder) {
    for (const auto& [room, inside] : allowed_inside) {
        Rooms placed;
        for (bool moved = true; moved;) {
            moved = false;
            for (const auto& [inner, may] : inside) {
                const bool ready = std::ranges::all_of(
                    may, [&](const std::string& other) { return placed.contains(other); });
                if (ready) moved = placed.insert(inner).second || moved;
            }
        }
        EXPECT_EQ(placed.size(), inside.size()) << room;
    }
}

TEST(LayeringCheck, SeesIncludesInEveryForm) {
    EXPECT_EQ(
        included_rooms(
            "#include \"stormcellar/render/image.h\"\n  # include \"stormcellar/grid/grid.h\"\n"),
        (Rooms{"render", "grid"}));
    EXPECT_EQ(included_rooms("// says \"stormcellar/render/image.h\"\n#include <vector>\n"),
              Rooms{});
}

// Every folder with C++ is a room of the list, or a folder that may include all rooms; docs has
// examples.
TEST(LayeringCheck, KnowsEveryRoom) {
    const Rooms free = {"tests", "bench", "build", "docs", "include", "out"};
    for (const auto& entry : fs::directory_iterator(testing::source_directory())) {
        const std::string name = entry.path().filename();
        if (!entry.is_directory() || name.starts_with(".") || free.contains(name)) continue;
        if (!testing::sources_below(entry.path()).empty()) {
            EXPECT_TRUE(allowed.contains(name)) << name << " is not in the list of rooms";
        }
    }
}

}  // namespace
}  // namespace stormcellar
