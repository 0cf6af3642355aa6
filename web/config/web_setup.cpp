#include "web/config/web_setup.h"

#include <array>
#include <optional>
#include <system_error>

#include "base/added_stations.h"
#include "base/printable.h"
#include "base/toml_file.h"

namespace stormcellar::web {
namespace {

// Tables of stormcellard.toml that other programs read.
constexpr std::array<std::string_view, 10> tables_of_others = {
    "ingest", "cache", "domain", "partials", "loop", "catalog", "watch", "status", "pull", "feed"};

void read_directory(TomlTable& paths, std::string_view key, const std::filesystem::path& file,
                    std::filesystem::path& directory) {
    const auto text = paths.text(key);
    if (!text) return;
    if (text->empty()) return paths.complain(key, "must not be empty");
    std::error_code ignored;
    const auto path = std::filesystem::absolute(file, ignored).parent_path() / *text;
    directory = path.lexically_normal();
}

void read_log_level(TomlTable log, std::string& level) {
    const auto given = log.text("level");
    if (!given) return;
    for (const char* known : {"debug", "info", "warning", "error"})
        if (*given == known) level = *given;
    if (level != *given)
        log.complain("level", fmt::format("\"{}\" must be one of debug, info, warning, error",
                                          printable(*given)));
}

}  // namespace

Result<WebSetup> load_web_setup(const std::filesystem::path& file) {
    Result<TomlFile> toml = TomlFile::open(file);
    if (!toml) return pass_on(toml);
    TomlTable root = toml->root();
    WebSetup setup;
    TomlTable paths = root.section("paths");
    read_directory(paths, "drop", file, setup.drop);
    read_directory(paths, "state", file, setup.state);
    read_directory(paths, "cache", file, setup.cache);
    setup.catalog = setup.state / "catalog";
    setup.added_stations = read_added_stations(root);
    read_log_level(root.section("log"), setup.log_level);
    setup.web = read_web_config(root);
    setup.loops = read_served_loops(file);
    for (const std::string_view table : tables_of_others)
        root.leave(table);
    if (const Status read = toml->finish(); !read) return pass_on(read);
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
