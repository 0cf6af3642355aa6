#include "fetch/feed/feed_config.h"

#include <algorithm>

#include "base/printable.h"
#include "base/toml_file.h"
#include "service/config_keys.h"
#include "stormcellar/base/station_table.h"

namespace stormcellar::feed {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_stations = 400;

// Tables of other programs. The shipped file has all of them, and
// tests/fetch/feed/feed_config_test.cpp loads it, so the test fails if a name is missing here.
constexpr std::string_view tables_of_others[] = {
    "ingest", "cache",   "domain", "loop", "catalog", "watch",  "partials",
    "status", "station", "web",    "pull", "notify",  "overlay"};

void read_stations(TomlTable& feed, std::vector<std::string>& stations) {
    if (feed.is_text("stations")) {
        if (*feed.text("stations") != "known")
            feed.complain("stations", "must be \"known\" or a list such as [\"KTLX\", \"KFDR\"]");
        for (const Station& station : all_stations())
            stations.emplace_back(station.icao);
        return;
    }
    const auto listed = feed.texts("stations");
    if (!listed) return;
    if (listed->size() > most_stations) feed.complain("stations", "has too many entries");
    for (const std::string& icao : *listed) {
        if (!is_icao(icao))
            feed.complain("stations", fmt::format("\"{}\" is not an ICAO", printable(icao)));
        if (!std::ranges::count(stations, icao)) stations.push_back(icao);
    }
}

bool is_within(const fs::path& inner, const fs::path& outer) {
    const auto [stopped, ignored] = std::ranges::mismatch(outer, inner);
    return stopped == outer.end() || (stopped->empty() && std::next(stopped) == outer.end());
}

void read_addresses(TomlTable& feed, FeedConfig& config) {
    config.bucket = feed.text("bucket").value_or(config.bucket);
    while (config.bucket.ends_with('/'))
        config.bucket.pop_back();
    if (!is_web_address(config.bucket))
        feed.complain("bucket", "must be an address such as https://chunks.example.org");
    config.proxy = feed.text("proxy").value_or("");
    if (!config.proxy.empty() && !is_web_address(config.proxy))
        feed.complain("proxy",
                      "must be an address such as http://proxy.example.org:3128, or empty");
}

void read_feed(TomlTable feed, const fs::path& file, FeedConfig& config) {
    read_stations(feed, config.stations);
    read_addresses(feed, config);
    read_path_beside(feed, "drop", file, config.drop);
    read_path_beside(feed, "state", file, config.state);
    read_duration(feed, "every_seconds", {4, 60}, std::chrono::seconds{1}, config.every);
    read_duration(feed, "keep_hours", {0.5, 1e6}, std::chrono::hours{1}, config.keep);
    if (const auto seconds = feed.whole_number("stall_seconds", {1, 120}))
        config.stall = std::chrono::seconds{*seconds};
    read_bytes(feed, "bytes", config.bytes);
    if (const auto text = feed.text("ca_file"); text && !text->empty()) {
        fs::path path;
        read_path_beside(feed, "ca_file", file, path);
        config.ca_file = path.native();
    }
}

}  // namespace

Result<FeedConfig> load_feed_config(const fs::path& file) {
    Result<TomlFile> toml = TomlFile::open(file);
    if (!toml) return pass_on(toml);
    TomlTable root = toml->root();
    FeedConfig config;
    TomlTable feed = root.section("feed");
    read_feed(feed, file, config);
    fs::path daemons = config.drop;
    TomlTable paths = root.section("paths");
    read_path_beside(paths, "drop", file, daemons);
    if (!config.stations.empty() && !is_within(config.drop, daemons)) {
        feed.complain("drop", fmt::format("must be [paths] drop, {}, or below it: stormcellard "
                                          "reads nothing else",
                                          printable(daemons.native())));
    }
    paths.leave("state");
    paths.leave("cache");
    read_log_level(root, config.log_level);
    if (const Status read = finish(*toml, tables_of_others); !read) return pass_on(read);
    return config;
}

}  // namespace stormcellar::feed
