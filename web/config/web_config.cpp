#include "web/config/web_config.h"

#include <algorithm>
#include <cmath>

#include <arpa/inet.h>
#include <fmt/format.h>

#include "base/byte_size.h"
#include "base/nearest_name.h"
#include "base/parse_number.h"
#include "base/printable.h"
#include "retrieve/hail/freezing_key.h"

namespace stormcellar::web {
namespace {

constexpr std::size_t most_entries = 64;  // of each list
constexpr std::size_t longest_text = 1024;

bool is_letter_or_digit(char letter) {
    return (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') ||
           (letter >= '0' && letter <= '9');
}

bool is_numeric_address(const std::string& text) {
    std::array<unsigned char, 16> bytes{};
    return ::inet_pton(AF_INET, text.c_str(), bytes.data()) == 1 ||
           ::inet_pton(AF_INET6, text.c_str(), bytes.data()) == 1;
}

std::string in_lower_case(std::string text) {
    for (char& letter : text)
        if (letter >= 'A' && letter <= 'Z') letter = static_cast<char>(letter - 'A' + 'a');
    return text;
}

std::optional<int> port_of(std::string_view text) {
    const auto port = parse_number<int>(text);
    return port && *port >= 0 && *port <= 65'535 ? port : std::nullopt;
}

// The host and the port of a text such as "example.org:80" or "[::1]:80". The port is after the
// last colon, or after the bracket.
struct HostAndPort {
    std::string_view host;  // without brackets
    std::optional<std::string_view> port;
};
std::optional<HostAndPort> split_authority(std::string_view text) {
    if (text.starts_with('[')) {
        const std::size_t end = text.find(']');
        if (end == std::string_view::npos) return std::nullopt;
        const std::string_view rest = text.substr(end + 1);
        if (!rest.empty() && rest.front() != ':') return std::nullopt;
        HostAndPort split{text.substr(1, end - 1), std::nullopt};
        if (!rest.empty()) split.port = rest.substr(1);
        return split;
    }
    const std::size_t colon = text.rfind(':');
    if (colon == std::string_view::npos) return HostAndPort{text, std::nullopt};
    return HostAndPort{text.substr(0, colon), text.substr(colon + 1)};
}

bool is_path_prefix(std::string_view prefix) {
    if (prefix.empty()) return true;
    if (prefix.front() != '/' || prefix.back() == '/' || prefix.find("//") != prefix.npos ||
        prefix.find("/.") != prefix.npos)
        return false;
    return std::ranges::all_of(prefix, [](char letter) {
        return is_letter_or_digit(letter) ||
               std::string_view{"/-._~"}.find(letter) != std::string_view::npos;
    });
}

// Returns true for the name of an S3 bucket: 3 to 63 lower-case letters, digits, "-" and ".".
bool is_bucket_name(std::string_view name) {
    return name.size() >= 3 && name.size() <= 63 && is_letter_or_digit(name.front()) &&
           is_letter_or_digit(name.back()) && name.find("..") == name.npos &&
           std::ranges::all_of(name, [](char letter) {
               return (letter >= 'a' && letter <= 'z') || (letter >= '0' && letter <= '9') ||
                      letter == '-' || letter == '.';
           });
}

std::optional<std::vector<std::string>> read_list(TomlTable& table, std::string_view key) {
    auto list = table.texts(key);
    if (!list || list->size() <= most_entries) return list;
    table.complain(key, fmt::format("must have at most {} entries", most_entries));
    return std::nullopt;
}

void read_listen(TomlTable& web, WebConfig& config) {
    const auto texts = read_list(web, "listen");
    if (!texts) return;
    if (texts->empty()) web.complain("listen", "must name an address");
    config.listen.clear();
    for (const std::string& text : *texts) {
        const auto address = parse_bind_address(text);
        if (!address) {
            web.complain("listen", address.error().message);
        } else if (address->port != 0 && std::ranges::count(config.listen, *address) > 0) {
            web.complain("listen", fmt::format("{} is named twice", address->text()));
        } else {
            config.listen.push_back(*address);
        }
    }
}

void read_names(TomlTable& web, WebConfig& config) {
    const auto names = read_list(web, "names");
    if (!names) return;
    for (const std::string& name : *names) {
        if (is_host_name(name)) {
            config.names.push_back(in_lower_case(name));
        } else {
            web.complain("names", fmt::format("\"{}\" is not the name of a host (without a port)",
                                              printable(name)));
        }
    }
}

void read_proxies(TomlTable& web, WebConfig& config) {
    const auto proxies = read_list(web, "trusted_proxies");
    if (!proxies) return;
    for (const std::string& proxy : *proxies) {
        if (is_numeric_address(proxy)) {
            config.trusted_proxies.push_back(proxy);
        } else {
            web.complain("trusted_proxies",
                         fmt::format("\"{}\" is not a numeric address", printable(proxy)));
        }
    }
}

void read_embedding(TomlTable& web, WebConfig& config) {
    const auto origins = read_list(web, "embed_in");
    if (!origins) return;
    for (const std::string& origin : *origins) {
        const auto address = parse_public_address(origin);
        if (address && address->prefix.empty()) {
            config.embed_in.push_back(address->text());
        } else {
            web.complain("embed_in", fmt::format("\"{}\" is not an origin, such as "
                                                 "https://example.org",
                                                 printable(origin)));
        }
    }
}

void read_parts(TomlTable& web, WebConfig& config) {
    const auto names = web.texts("serve");
    if (!names) return;
    config.serve.clear();
    static const std::vector<std::string> known(names_of_parts.begin(), names_of_parts.end());
    for (const std::string& name : *names) {
        const auto found = std::ranges::find(known, name);
        if (found == known.end()) {
            web.complain("serve", fmt::format("\"{}\" must be one of {}{}", printable(name),
                                              fmt::join(known, ", "), did_you_mean(name, known)));
            continue;
        }
        config.serve.push_back(static_cast<WebPart>(found - known.begin()));
    }
    std::ranges::sort(config.serve);
    config.serve.erase(std::unique(config.serve.begin(), config.serve.end()), config.serve.end());
}

void read_addresses(TomlTable& web, WebConfig& config) {
    read_listen(web, config);
    read_names(web, config);
    read_proxies(web, config);
    const auto text = web.text("public_address");
    if (text && !text->empty()) {
        const auto address = parse_public_address(*text);
        if (address) config.public_address = *address;
        if (!address) web.complain("public_address", address.error().message);
    }
    if (const auto cors = web.text("cors")) {
        if (*cors != "none" && *cors != "*")
            web.complain("cors", fmt::format("\"{}\" must be none or *", printable(*cors)));
        config.cors = *cors == "*";
    }
    read_embedding(web, config);
    if (const auto bucket = web.text("bucket")) {
        if (is_bucket_name(*bucket)) {
            config.bucket = *bucket;
        } else {
            web.complain("bucket", "must have 3 to 63 small letters, digits, - and .");
        }
    }
}

// Reads a data set. Its path becomes a part of addresses, so its segments consist of letters,
// digits and "-._".
void read_collection(TomlTable& table, ThreddsConfig& config) {
    ConfiguredCollection collection;
    collection.path = table.text("path").value_or("");
    collection.title = table.text("title").value_or(collection.path);
    collection.files = table.text("files").value_or("");
    collection.variables = read_list(table, "variables").value_or(std::vector<std::string>{});
    collection.stations = read_list(table, "stations").value_or(std::vector<std::string>{});
    if (!table.has("path")) {
        table.complain("path", "must be given");
    } else if (collection.path.empty() || !is_path_prefix("/" + collection.path)) {
        table.complain("path", "must be a path such as nexrad/level2/IDD");
    } else if (std::ranges::count(config.collections, collection.path,
                                  &ConfiguredCollection::path) > 0) {
        table.complain("path", fmt::format("{} is named twice", collection.path));
    }
    if (!collection.files.empty() && !collection.files.is_absolute())
        table.complain("files", "must be an absolute path");
    if (!collection.files.empty() && collection.variables.empty())
        table.complain("files", "needs variables, the products that the files have");
    if (collection.title.size() > longest_text) table.complain("title", "is too long");
    config.collections.push_back(std::move(collection));
}

void read_overlay(TomlTable& table, std::vector<ConfiguredOverlay>& overlays) {
    ConfiguredOverlay overlay;
    overlay.name = table.text("name").value_or("");
    overlay.path = table.text("path").value_or("");
    const bool is_segment = overlay.name.find('/') == std::string::npos;
    if (overlay.name.empty() || !is_segment || !is_path_prefix("/" + overlay.name)) {
        table.complain("name", "must be letters, digits and \"-._\", such as warnings");
    } else if (std::ranges::count(overlays, overlay.name, &ConfiguredOverlay::name) > 0) {
        table.complain("name", fmt::format("{} is named twice", overlay.name));
    }
    if (!overlay.path.is_absolute())
        table.complain("path", "must be the absolute path of a file or a directory");
    overlays.push_back(std::move(overlay));
}

void read_place(TomlTable& table, ThreddsConfig& config) {
    ConfiguredPlace place;
    place.id = table.text("id").value_or("");
    place.name = table.text("name").value_or(place.id);
    place.state = table.text("state").value_or("");
    if (place.id.empty() ||
        !std::ranges::all_of(place.id, [](char c) { return is_letter_or_digit(c); }))
        table.complain("id", "must be the letters and digits of a station, such as KFTG or FTG");
    const auto read = [&](std::string_view key, TomlRange range, double& value) {
        if (!table.has(key)) return table.complain(key, "must be given");
        if (const auto number = table.number(key, range)) value = *number;
    };
    read("latitude_deg", {-90, 90}, place.latitude_deg);
    read("longitude_deg", {-180, 180}, place.longitude_deg);
    read("altitude_m", {-500, 9000}, place.altitude_m);
    config.places.push_back(std::move(place));
}

void read_thredds(TomlTable table, ThreddsConfig& config) {
    if (const auto denied = read_list(table, "denied")) {
        config.denied = *denied;
        for (const std::string& path : *denied)
            if (path.empty() || !is_path_prefix("/" + path))
                table.complain("denied", fmt::format("\"{}\" must be the beginning of a path, "
                                                     "without a slash before and behind it",
                                                     printable(path)));
    }
    for (TomlTable& place : table.tables("station"))
        read_place(place, config);
    if (config.places.size() > most_entries)
        table.complain("station", fmt::format("at most {} can be given", most_entries));
    auto collections = table.tables("collection");
    if (collections.empty()) return;
    config.collections.clear();
    if (collections.size() > most_entries)
        table.complain("collection", fmt::format("at most {} can be given", most_entries));
    for (TomlTable& collection : collections)
        read_collection(collection, config);
}

void read_count(TomlTable& table, std::string_view key, TomlRange range, int& value) {
    if (const auto given = table.whole_number(key, range)) value = *given;
}

void read_size(TomlTable& table, std::string_view key, TomlRange range, std::uint64_t& value) {
    if (!table.is_text(key)) {
        if (const auto number = table.number(key, range))
            value = static_cast<std::uint64_t>(*number);
        return;
    }
    const auto size = parse_byte_size(*table.text(key));
    if (!size) {
        table.complain(key, size.error().message);
    } else if (static_cast<double>(*size) < range.least ||
               static_cast<double>(*size) > range.most) {
        table.complain(key, fmt::format("must be {} to {} bytes", range.least, range.most));
    } else {
        value = *size;
    }
}

void read_seconds(TomlTable& table, std::string_view key, TomlRange range,
                  std::chrono::seconds& value) {
    if (const auto given = table.whole_number(key, range)) value = std::chrono::seconds{*given};
}

void read_limits(TomlTable table, WebLimits& limits) {
    read_count(table, "connections", {8, 100'000}, limits.connections);
    read_count(table, "connections_of_an_address", {2, 100'000}, limits.connections_of_an_address);
    read_count(table, "event_streams", {0, 100'000}, limits.event_streams);
    read_count(table, "event_streams_of_a_client", {1, 100'000}, limits.event_streams_of_a_client);
    read_size(table, "header_bytes", {1024, 1 << 20}, limits.header_bytes);
    read_seconds(table, "request_seconds", {1, 3600}, limits.request);
    read_size(table, "least_bytes_per_second", {0, 1e9}, limits.least_bytes_per_second);
    read_count(table, "workers", {0, 256}, limits.workers);
    read_count(table, "renders", {1, 64}, limits.renders);
    read_count(table, "waiting", {0, 10'000}, limits.waiting);
    read_count(table, "results", {1, 1'000'000}, limits.results);
    read_size(table, "kept_bytes", {1e6, 1e12}, limits.kept_bytes);
    read_size(table, "kept_picture_bytes", {1e6, 1e12}, limits.kept_picture_bytes);
    read_count(table, "open_grids", {1, 4096}, limits.open_grids);
    read_size(table, "answer_bytes", {1e6, 1e12}, limits.answer_bytes);
}

}  // namespace

std::string BindAddress::text() const {
    return host.find(':') == std::string::npos ? fmt::format("{}:{}", host, port)
                                               : fmt::format("[{}]:{}", host, port);
}

Result<BindAddress> parse_bind_address(std::string_view text) {
    const auto split = split_authority(text);
    const auto port = split && split->port ? port_of(*split->port) : std::nullopt;
    const bool has_brackets = text.starts_with('[');
    if (!port || !is_numeric_address(std::string{split->host}) ||
        has_brackets != (split->host.find(':') != std::string_view::npos)) {
        return fail(ErrorCode::bad_argument,
                    "\"{}\" is not ADDRESS:PORT with a numeric address, as in 127.0.0.1:8090 or "
                    "[::1]:8090",
                    printable(text));
    }
    return BindAddress{std::string{split->host}, *port};
}

std::vector<WebPart> all_parts() {
    std::vector<WebPart> parts;
    for (std::size_t i = 0; i < names_of_parts.size(); ++i)
        parts.push_back(static_cast<WebPart>(i));
    return parts;
}

std::string PublicAddress::text() const {
    return scheme + "://" + authority + prefix;
}

std::string PublicAddress::host() const {
    const auto split = split_authority(authority);
    return split ? std::string{split->host} : authority;
}

Result<PublicAddress> parse_public_address(std::string_view text) {
    PublicAddress address;
    const std::size_t colon = text.find("://");
    if (colon != text.npos) {
        address.scheme = in_lower_case(std::string{text.substr(0, colon)});
        text.remove_prefix(colon + 3);
    }
    const std::size_t slash = std::min(text.find('/'), text.size());
    address.authority = in_lower_case(std::string{text.substr(0, slash)});
    address.prefix = text.substr(slash);
    if (address.prefix.ends_with('/')) address.prefix.pop_back();
    const auto split = split_authority(address.authority);
    const bool is_valid = (address.scheme == "http" || address.scheme == "https") && split &&
                          is_host_name(split->host) && (!split->port || port_of(*split->port)) &&
                          is_path_prefix(address.prefix);
    if (is_valid) return address;
    return fail(ErrorCode::bad_argument,
                "must be http://HOST or https://HOST with a port and a path if need be, as in "
                "https://radar.example.org/storms");
}

bool is_host_name(std::string_view text) {
    if (text.empty() || text.size() > 253) return false;
    if (is_numeric_address(std::string{text})) return true;
    if (text.front() == '.' || text.front() == '-' || text.find("..") != text.npos) return false;
    return std::ranges::all_of(text, [](char letter) {
        return is_letter_or_digit(letter) || letter == '-' || letter == '.';
    });
}

bool WebConfig::serves(WebPart part) const {
    return std::ranges::count(serve, part) > 0;
}

ThreddsConfig WebConfig::usual_thredds() {
    return {{{"nexrad/level2/IDD", "NEXRAD Level II Radar from IDD", {}, {}, {}}}, {}, {}};
}

WebConfig read_web_config(TomlTable& root) {
    WebConfig config;
    TomlTable web = root.section("web");
    read_addresses(web, config);
    read_parts(web, config);
    read_seconds(web, "silent_seconds", {60, 86'400}, config.silent);
    retrieve::read_freezing_levels(web, config.freezing);
    read_thredds(web.section("thredds"), config.thredds);
    read_limits(web.section("limits"), config.limits);
    for (TomlTable& table : root.tables("overlay"))
        read_overlay(table, config.overlays);
    return config;
}

}  // namespace stormcellar::web
