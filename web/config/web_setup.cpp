#include "web/config/web_setup.h"

#include <array>
#include <optional>
#include <string_view>

#include "base/added_stations.h"
#include "base/toml_file.h"
#include "service/config_keys.h"

namespace stormcellar::web {
namespace {

// Tables of stormcellard.toml that other programs read.
constexpr std::array<std::string_view, 11> tables_of_others = {
    "ingest", "cache",  "domain", "partials", "loop",  "catalog",
    "watch",  "status", "pull",   "feed",     "notify"};

}  // namespace

Result<WebSetup> load_web_setup(const std::filesystem::path& file) {
    Result<TomlFile> toml = TomlFile::open(file);
    if (!toml) return pass_on(toml);
    TomlTable root = toml->root();
    WebSetup setup;
    TomlTable paths = root.section("paths");
    read_path_beside(paths, "drop", file, setup.drop);
    read_path_beside(paths, "state", file, setup.state);
    read_path_beside(paths, "cache", file, setup.cache);
    setup.catalog = setup.state / "catalog";
    setup.added_stations = read_added_stations(root);
    read_log_level(root, setup.log_level);
    setup.web = read_web_config(root);
    setup.loops = read_served_loops(file);
    if (const Status read = finish(*toml, tables_of_others); !read) return pass_on(read);
    return setup;
}

std::vector<std::string> needs_restart(const WebSetup& fresh, const WebSetup& running) {
    std::vector<std::string> sentences;
    const auto say = [&](bool differs, std::string_view what) {
        if (differs)
            sentences.push_back(
                fmt::format("restart the service for the change of {} to take effect", what));
    };
    say(fresh.drop != running.drop || fresh.state != running.state || fresh.cache != running.cache,
        "[paths]");
    say(fresh.added_stations != running.added_stations, "[[station]]");
    return sentences;
}

}  // namespace stormcellar::web
