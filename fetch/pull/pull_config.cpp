#include "fetch/pull/pull_config.h"

#include <algorithm>

#include "base/printable.h"
#include "base/toml_file.h"
#include "service/config_keys.h"
#include "stormcellar/base/station_table.h"
#include "stormcellar/cache/grid_name.h"

namespace stormcellar::pull {
namespace {

constexpr std::size_t most_sources = 32;  // each source has a thread
constexpr std::size_t most_domains = 64;
constexpr std::size_t most_stations = 1024;

// Tables of other programs. The shipped file has all of them, and
// tests/fetch/pull/pull_config_test.cpp loads it, so the test fails if a name is missing here.
constexpr std::string_view tables_of_others[] = {
    "paths",    "ingest", "cache",   "domain", "loop", "catalog", "watch",
    "partials", "status", "station", "web",    "feed", "notify",  "overlay"};

void read_domains(TomlTable& from, PullSource& source) {
    const auto domains = from.texts("domains");
    if (!domains) return;
    if (domains->size() > most_domains) from.complain("domains", "has too many entries");
    for (const std::string& domain : *domains) {
        if (!cache::is_domain_name(domain) || cache::is_part(domain)) {
            from.complain("domains",
                          fmt::format("\"{}\" is not the name of a domain", printable(domain)));
        }
    }
    source.domains = *domains;
}

void read_stations(TomlTable& from, PullSource& source) {
    const auto stations = from.texts("stations");
    if (!stations) return;
    if (stations->size() > most_stations) from.complain("stations", "has too many entries");
    for (const std::string& icao : *stations) {
        if (!is_icao(icao))
            from.complain("stations", fmt::format("\"{}\" is not an ICAO", printable(icao)));
    }
    source.stations = *stations;
}

void read_source(TomlTable from, std::vector<PullSource>& sources) {
    PullSource source;
    source.name = from.text("name").value_or("");
    source.url = from.text("url").value_or("");
    while (source.url.ends_with('/'))
        source.url.pop_back();
    const auto is_taken = [&](const PullSource& other) { return other.name == source.name; };
    if (!cache::is_domain_name(source.name) || cache::is_part(source.name)) {
        from.complain("name",
                      "must consist of letters, digits, _ and -, because it names a directory");
    } else if (std::ranges::any_of(sources, is_taken)) {
        from.complain("name", fmt::format("{} is named twice", source.name));
    } else if (!is_web_address(source.url)) {
        from.complain("url", "must be an address such as http://north.example.org:8090");
    }
    read_domains(from, source);
    read_stations(from, source);
    sources.push_back(std::move(source));
}

void read_pull(TomlTable pull, const std::filesystem::path& file, PullConfig& config) {
    read_path_beside(pull, "directory", file, config.directory);
    read_duration(pull, "every_seconds", {0.1, 3600}, std::chrono::seconds{1}, config.every);
    read_duration(pull, "age_hours", {0.1, 1e6}, std::chrono::hours{1}, config.age);
    if (const auto seconds = pull.whole_number("stall_seconds", {1, 600}))
        config.stall = std::chrono::seconds{*seconds};
    read_bytes(pull, "bytes", config.bytes_a_source);
    const auto tables = pull.tables("from");
    if (tables.size() > most_sources) pull.complain("from", "names too many machines");
    for (const TomlTable& from : tables)
        read_source(from, config.sources);
}

}  // namespace

Result<PullConfig> load_pull_config(const std::filesystem::path& file) {
    Result<TomlFile> toml = TomlFile::open(file);
    if (!toml) return pass_on(toml);
    TomlTable root = toml->root();
    PullConfig config;
    read_pull(root.section("pull"), file, config);
    read_log_level(root, config.log_level);
    if (const Status read = finish(*toml, tables_of_others); !read) return pass_on(read);
    return config;
}

}  // namespace stormcellar::pull
