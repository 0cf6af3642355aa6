#include "cli/shared/service_places.h"

#include <cstdlib>

#include <CLI/CLI.hpp>
#include <unistd.h>

#include "base/toml_file.h"

namespace stormcellar::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* usual_config = "/etc/stormcellar/stormcellard.toml";
constexpr const char* variable = "STORMCELLAR_CONFIG";

// Returns the path of the configuration, or an empty path if there is none.
fs::path config_in_use(const std::string& named) {
    if (!named.empty()) return named;
    if (const char* const by_variable = std::getenv(variable);
        by_variable != nullptr && *by_variable != '\0') {
        return by_variable;
    }
    return ::access(usual_config, R_OK) == 0 ? fs::path{usual_config} : fs::path{};
}

}  // namespace

Result<std::optional<ServicePlaces>> service_places(const std::string& config) {
    ServicePlaces places;
    places.config = config_in_use(config);
    if (places.config.empty()) return std::optional<ServicePlaces>{};
    // Read only the keys for the directories, because the service checks the rest of the file.
    auto toml = TomlFile::open(places.config);
    if (!toml) return pass_on(toml);
    TomlTable root = toml->root();
    const fs::path directory = fs::absolute(places.config).parent_path();
    const auto path_of = [&](TomlTable& table, const char* key) -> std::optional<fs::path> {
        const auto text = table.text(key);
        if (!text || text->empty()) return std::nullopt;
        return (directory / *text).lexically_normal();
    };
    TomlTable paths = root.section("paths");
    places.drop = path_of(paths, "drop").value_or(fs::path{});
    places.state = path_of(paths, "state").value_or(places.state);
    places.cache = path_of(paths, "cache").value_or(places.cache);
    TomlTable status = root.section("status");
    places.socket = path_of(status, "socket");
    return std::optional{places};
}

Status PlaceOption::find() {
    if (!directory.empty()) return {};
    const auto places = service_places(config);
    if (!places) return pass_on(places);
    const bool is_cache = which == Directory::cache;
    if (!*places) {
        const char* const name = is_cache ? "cache" : "catalog";
        return fail(ErrorCode::bad_argument,
                    "say where the {0} is: --{0} DIRECTORY, or --config FILE (or {1}) for the "
                    "configuration of the service",
                    name, variable);
    }
    directory = (is_cache ? (*places)->cache : (*places)->catalog()).native();
    return {};
}

void add_config_option(CLI::App& app, std::string& config) {
    app.add_option("--config", config,
                   "Configuration file of the service, which says where its directories are. "
                   "Default: $STORMCELLAR_CONFIG, else /etc/stormcellar/stormcellard.toml");
}

void add_place(CLI::App& app, PlaceOption& place) {
    if (place.which == Directory::cache) {
        app.add_option("--cache", place.directory,
                       "Directory of the cache. Default: that of the service");
    } else {
        app.add_option("--catalog", place.directory,
                       "Directory of the catalog (state/catalog). Default: that of the service");
    }
    add_config_option(app, place.config);
}

}  // namespace stormcellar::cli
