#include "cli/reference/completed_names.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include <fmt/format.h>

#include "cli/shared/commands.h"
#include "cli/shared/service_places.h"
#include "stormcellar/base/station_table.h"
#include "stormcellar/cache/store.h"
#include "stormcellar/catalog/radar_set.h"

namespace stormcellar::cli {
namespace {

namespace fs = std::filesystem;

// Returns the path that was typed. A shell passes a leading ~ on without expanding it.
fs::path typed_path(const std::string& text) {
    const char* const home = std::getenv("HOME");
    if (home == nullptr || !text.starts_with("~/")) return text;
    return fs::path(home) / text.substr(2);
}

// Returns the value after this option, or an empty text. Bash splits "--cache=x" into the words
// "--cache", "=" and "x".
std::string value_behind(std::string_view option, const std::vector<std::string>& words) {
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (words[i].starts_with(option) && words[i].size() > option.size() &&
            words[i][option.size()] == '=')
            return words[i].substr(option.size() + 1);
        if (words[i] != option || i + 1 >= words.size()) continue;
        const bool is_split = words[i + 1] == "=" && i + 2 < words.size();
        return words[i + (is_split ? 2 : 1)];
    }
    return {};
}

// Returns a directory of the service. Returns an empty path if no readable configuration names it.
fs::path configured(Directory which, const std::vector<std::string>& words) {
    const std::string file = value_behind("--config", words);
    const auto places = service_places(file.empty() ? file : typed_path(file).native());
    if (!places || !*places) return {};
    return which == Directory::cache ? (*places)->cache : (*places)->catalog();
}

std::vector<std::string> domains_of(const std::vector<std::string>& words) {
    fs::path cache = typed_path(value_behind("--cache", words));
    if (cache.empty()) cache = configured(Directory::cache, words);
    if (cache.empty()) return {};
    const auto store = cache::StoreReader::open(cache);
    if (!store) return {};
    return store->domains().value_or(std::vector<std::string>{});
}

std::vector<std::string> stations_of(const std::vector<std::string>& words) {
    std::vector<std::string> stations;
    fs::path catalog = typed_path(value_behind("--catalog", words));
    if (catalog.empty()) catalog = configured(Directory::catalog, words);
    if (!catalog.empty()) {
        if (const auto sets = catalog::RadarSet::open_all(catalog)) {
            for (const catalog::RadarSet& set : *sets)
                stations.push_back(set.station());
        }
    }
    if (stations.empty()) {
        for (const std::string& domain : domains_of(words))
            if (is_icao(domain)) stations.push_back(domain);
    }
    if (stations.empty()) {
        for (const Station& station : all_stations())
            stations.emplace_back(station.icao);
    }
    return stations;
}

}  // namespace

std::vector<std::string> completed_names(std::string_view kind,
                                         const std::vector<std::string>& words) {
    std::vector<std::string> names;
    if (kind == "domains") names = domains_of(words);
    if (kind == "stations") names = stations_of(words);
    // Leave out names that a shell would split into several words.
    std::erase_if(names, [](const std::string& name) {
        return name.empty() || name.find_first_of(" \t\n\\'\"$`:") != std::string::npos;
    });
    std::ranges::sort(names);
    names.erase(std::unique(names.begin(), names.end()), names.end());
    return names;
}

int print_completions(std::string_view kind, const std::vector<std::string>& words) {
    for (const std::string& name : completed_names(kind, words))
        fmt::print("{}\n", printable(name));
    return exit_done;
}

}  // namespace stormcellar::cli
