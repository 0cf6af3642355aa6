// cli/shared/service_places.h -- finds a service's cache and catalog from its configuration.
//
// The configuration is the file named by --config FILE, else by the environment variable
// STORMCELLAR_CONFIG, else /etc/stormcellar/stormcellard.toml if that can be read. A directory that
// is given as an option takes precedence over the configuration.
//
// Threads   One thread at a time.
// Errors    See each function.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "cli/shared/commands.h"
#include "stormcellar/base/result.h"

namespace stormcellar::cli {

// Default state directory of a service.
inline constexpr const char* usual_state = "/var/lib/stormcellar";
inline constexpr const char* usual_cache = "/var/cache/stormcellar";

struct ServicePlaces {
    std::filesystem::path config;  // the file that names the directories below
    std::filesystem::path drop;    // drop directory; empty: the file names none
    std::filesystem::path state = usual_state;
    std::filesystem::path cache = usual_cache;
    std::optional<std::filesystem::path> socket = std::nullopt;

    [[nodiscard]] std::filesystem::path catalog() const { return state / "catalog"; }
};

// Returns the directories that the configuration names. Returns none if no configuration is named
// and none is in the usual place. Errors: those of reading a named file, and bad_argument for its
// contents.
[[nodiscard]] Result<std::optional<ServicePlaces>> service_places(const std::string& config);

enum class Directory { cache, catalog };

// A directory of the service that --cache, --catalog or --config names.
struct PlaceOption {
    Directory which = Directory::cache;
    std::string directory;  // as typed; find() sets it if empty
    std::string config;

    // Looks the directory up in the configuration if it was not typed. Errors: bad_argument, with
    // advice, if no configuration names the directory; those of service_places().
    [[nodiscard]] Status find();
};
// Adds the option for the directory, and --config. `place` must outlive the parse.
void add_place(CLI::App& app, PlaceOption& place);
void add_config_option(CLI::App& app, std::string& config);

}  // namespace stormcellar::cli
