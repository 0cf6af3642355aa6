#include "notify/notify_config.h"

#include <algorithm>
#include <charconv>

#include "base/printable.h"
#include "base/toml_file.h"
#include "grid/frame/named_place.h"
#include "retrieve/hail/freezing_key.h"
#include "service/config_keys.h"
#include "stormcellar/cache/grid_name.h"

namespace stormcellar::notify {
namespace {

constexpr std::size_t most_rules = 64;  // each rule has a thread
constexpr std::size_t longest_topic = 256;

struct MqttScheme {
    std::string_view start;
    bool tls = false;
    int port = 0;
};
constexpr MqttScheme mqtt_schemes[] = {{"mqtt://", false, 1883}, {"mqtts://", true, 8883}};

// Tables of other programs. The shipped file has all of these tables, and
// tests/notify/notify_config_test.cpp loads it, so the test fails if a name is missing here.
constexpr std::string_view tables_of_others[] = {
    "ingest", "cache",   "domain", "loop", "catalog", "watch",  "partials",
    "status", "station", "web",    "pull", "feed",    "overlay"};

bool is_name(std::string_view name) {
    return cache::is_domain_name(name) && !cache::is_part(name);
}

// Reads a latitude and a longitude, or a name.
void read_point(TomlTable& table, NotifyRule& rule) {
    std::vector<double> place;
    if (table.is_text("place")) {
        const auto named = grid::place_named(table.text("place").value_or(""));
        if (!named) return table.complain("place", named.error().message);
        place = {named->latitude_deg, named->longitude_deg};
    } else {
        place = table.numbers("place").value_or(place);
    }
    const bool is_point =
        place.size() == 2 && std::abs(place[0]) <= 90 && std::abs(place[1]) <= 180;
    if (!is_point) {
        return table.complain("place",
                              "must be a latitude and a longitude in degrees, as in [35.4, "
                              "-97.6], a town as in \"Moore, OK\", or a radar as in \"KTLX\"");
    }
    rule.latitude_deg = place[0];
    rule.longitude_deg = place[1];
}

void read_place(TomlTable& table, NotifyRule& rule) {
    read_point(table, rule);
    const auto radius = table.number("radius_km", {0.1, 1000});
    if (radius) rule.radius_km = *radius;
    if (!table.has("radius_km")) table.complain("radius_km", "must be given");
}

void read_thresholds(TomlTable& table, Thresholds& thresholds) {
    thresholds.max_dbz = table.number("max_dbz", {0, 80});
    thresholds.vil_kg_per_m2 = table.number("vil_kg_per_m2", {0, 200});
    thresholds.mesh_mm = table.number("mesh_mm", {0, 200});
    thresholds.top_km = table.number("top_km", {0, 25});
    const bool has_any = table.has("max_dbz") || table.has("vil_kg_per_m2") ||
                         table.has("mesh_mm") || table.has("top_km");
    if (!has_any)
        table.complain("max_dbz",
                       "or vil_kg_per_m2, mesh_mm or top_km must be given: otherwise every "
                       "cell would be sent");
}

// Splits "HOST:PORT" (an IPv6 host has brackets). Without a port, takes the port of the scheme.
std::optional<MqttAddress> host_and_port(std::string_view text, const MqttScheme& scheme) {
    MqttAddress address{.host = {}, .port = scheme.port, .topic = {}, .tls = scheme.tls};
    const std::size_t bracket = text.find(']');
    const std::size_t colon = text.find(':', bracket == std::string_view::npos ? 0 : bracket);
    if (colon != std::string_view::npos) {
        const std::string_view digits = text.substr(colon + 1);
        const char* const end = digits.data() + digits.size();
        const auto [stopped, error] = std::from_chars(digits.data(), end, address.port);
        if (error != std::errc{} || stopped != end || address.port < 1 || address.port > 65'535)
            return std::nullopt;
        text = text.substr(0, colon);
    }
    if (text.starts_with('[') && text.ends_with(']')) text = text.substr(1, text.size() - 2);
    address.host = text;
    return text.empty() ? std::nullopt : std::optional{address};
}

std::optional<MqttAddress> parse_mqtt(std::string_view text) {
    const auto* const scheme = std::ranges::find_if(
        mqtt_schemes, [&](const MqttScheme& one) { return text.starts_with(one.start); });
    if (scheme == std::end(mqtt_schemes)) return std::nullopt;
    text.remove_prefix(scheme->start.size());
    const std::size_t slash = text.find('/');
    if (slash == std::string_view::npos || !is_web_address(fmt::format("http://{}", text)))
        return std::nullopt;
    auto address = host_and_port(text.substr(0, slash), *scheme);
    if (!address) return std::nullopt;
    address->topic = text.substr(slash + 1);
    if (address->topic.empty() || address->topic.size() > longest_topic) return std::nullopt;
    return address;
}

void read_address(TomlTable& table, const std::filesystem::path& file, NotifyRule& rule) {
    const auto url = table.text("url");
    const auto mqtt = table.text("mqtt");
    if (table.has("url") == table.has("mqtt"))
        table.complain("url", "or mqtt must be given, and not both");
    if (url) {
        rule.url = *url;
        if (!is_web_address(*url))
            table.complain("url", "must be an address such as https://hooks.example.org/storms");
    }
    if (mqtt) {
        const auto address = parse_mqtt(*mqtt);
        if (address) rule.mqtt = *address;
        if (!address)
            table.complain("mqtt", "must be an address such as mqtt://127.0.0.1:1883/storms/moore");
    }
    read_path_beside(table, "password_file", file, rule.password_file);
    if (!rule.password_file.empty() && !mqtt) table.complain("password_file", "is for mqtt only");
}

void read_rule(TomlTable table, const std::filesystem::path& file, std::vector<NotifyRule>& rules) {
    NotifyRule rule;
    rule.name = table.text("name").value_or("");
    rule.area = table.text("area").value_or("");
    const auto is_taken = [&](const NotifyRule& other) { return other.name == rule.name; };
    if (!is_name(rule.name)) {
        table.complain("name",
                       "must consist of letters, digits, _ and -, because it names a directory");
    } else if (std::ranges::any_of(rules, is_taken)) {
        table.complain("name", fmt::format("{} is named twice", rule.name));
    }
    if (!is_name(rule.area))
        table.complain("area", "must be a station such as KTLX, or the name of a [[domain]]");
    read_place(table, rule);
    read_thresholds(table, rule.thresholds);
    read_duration(table, "every_minutes", {1, 1440}, std::chrono::minutes{1}, rule.every);
    read_address(table, file, rule);
    rules.push_back(std::move(rule));
}

}  // namespace

Result<NotifyConfig> load_notify_config(const std::filesystem::path& file) {
    Result<TomlFile> toml = TomlFile::open(file);
    if (!toml) return pass_on(toml);
    TomlTable root = toml->root();
    NotifyConfig config;
    TomlTable paths = root.section("paths");
    read_path_beside(paths, "cache", file, config.cache);
    paths.leave("drop");
    paths.leave("state");
    TomlTable notify = root.section("notify");
    read_path_beside(notify, "directory", file, config.directory);
    retrieve::read_freezing_levels(notify, config.freezing);
    const auto tables = notify.tables("rule");
    if (tables.size() > most_rules) notify.complain("rule", "has too many tables");
    for (const TomlTable& table : tables)
        read_rule(table, file, config.rules);
    read_log_level(root, config.log_level);
    if (const Status read = finish(*toml, tables_of_others); !read) return pass_on(read);
    return config;
}

}  // namespace stormcellar::notify
