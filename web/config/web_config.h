// web/config/web_config.h -- the tables [web] of stormcellard.toml: what the data server serves,
// whom it answers, and how much it may take. daemon/stormcellard.toml explains every key and holds
// every default.
//
// This is a separate library (stormcellar::web_config), so that stormcellard can check the tables
// without linking the server.
//
// Units     Bytes, seconds.
// Threads   Plain data and pure functions.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/toml_file.h"
#include "stormcellar/base/result.h"
#include "stormcellar/retrieve/hail.h"

namespace stormcellar::web {

// A numeric address and a port. Port 0: the system chooses one.
struct BindAddress {
    std::string host;  // "127.0.0.1", or "::1" without brackets
    int port = 0;

    [[nodiscard]] std::string text() const;  // "127.0.0.1:8090", "[::1]:8090"
    bool operator==(const BindAddress&) const = default;
};
// Reads ADDRESS:PORT with a numeric address. Errors: bad_argument for any other text.
[[nodiscard]] Result<BindAddress> parse_bind_address(std::string_view text);

// The parts that the server can offer, in the order of names_of_parts.
enum class WebPart {
    volumes,   // raw files: /volumes
    thredds,   // the THREDDS radar server: /thredds
    polling,   // files for GR2Analyst and GRLevel2: /nexrd2
    s3,        // the listing of a bucket: /s3
    grids,     // JSON, packed grids, netCDF: /api/v1
    zarr,      // /zarr and /zarr3
    pictures,  // frames, loops, tiles, WMS and overlays: /frames, /loops, /tiles, /wms, /overlays
    events,    // /api/v1/events
    metrics,   // /metrics
};
inline constexpr std::array<std::string_view, 9> names_of_parts = {
    "volumes", "thredds", "polling", "s3", "grids", "zarr", "pictures", "events", "metrics"};
[[nodiscard]] std::vector<WebPart> all_parts();

// The address under which clients reach the server through a proxy: "https://example.org/storms".
struct PublicAddress {
    std::string scheme;     // "http" or "https"
    std::string authority;  // "example.org" or "example.org:8443"
    std::string prefix;     // "/storms"; empty: none

    [[nodiscard]] std::string text() const;
    [[nodiscard]] std::string host() const;  // without the port, and without brackets
    bool operator==(const PublicAddress&) const = default;
};
// Reads a public address. Errors: bad_argument.
[[nodiscard]] Result<PublicAddress> parse_public_address(std::string_view text);

// Returns true if the text may be the name of a host: letters, digits, "-" and "." as in DNS, or a
// numeric address without brackets.
[[nodiscard]] bool is_host_name(std::string_view text);

// A data set of the THREDDS radar server.
struct ConfiguredCollection {
    std::string path;  // "nexrad/level2/IDD"
    std::string title;
    // Names of Level III products, such as N0Q. If empty, the data set has the Level II files of
    // the catalog.
    std::vector<std::string> variables;
    // A directory of Level III files with names such as Level3_FTG_N0Q_20150615_1201.nids. If
    // empty, the data set is described, but has no files.
    std::filesystem::path files;
    std::vector<std::string> stations;  // stations to list; empty: all stations that have files
    bool operator==(const ConfiguredCollection&) const = default;
};

// A station as the THREDDS radar server describes it. This replaces its row in the station table.
struct ConfiguredPlace {
    std::string id;  // "KFTG", or "FTG" as in Level III
    std::string name, state;
    double latitude_deg = 0, longitude_deg = 0, altitude_m = 0;
    bool operator==(const ConfiguredPlace&) const = default;
};

struct ThreddsConfig {
    std::vector<ConfiguredCollection> collections;  // never empty
    std::vector<ConfiguredPlace> places;
    std::vector<std::string> denied;  // prefixes of paths below /thredds that get 403
    bool operator==(const ThreddsConfig&) const = default;
};

struct WebLimits {
    int connections = 1024;
    int connections_of_an_address = 256;  // trusted proxies may use all connections
    int event_streams = 2048;             // not counted in `connections`
    int event_streams_of_a_client = 64;
    std::uint64_t header_bytes = 32'768;
    std::chrono::seconds request{20};  // from opening or the last answer to the end of the headers
    std::uint64_t least_bytes_per_second = 1'000;  // a slower client is cut off
    int workers = 0;                               // 0: two for each processor
    int renders = 1;                               // pictures and grids computed at the same time
    // Number of requests that may wait for a render; further requests get 503.
    int waiting = 32;
    int results = 10'000;                    // rows of one query
    std::uint64_t kept_bytes = 256'000'000;  // packed grids and lists kept in memory
    std::uint64_t kept_picture_bytes = 64'000'000;
    int open_grids = 64;
    std::uint64_t answer_bytes = 256'000'000;  // memory of all answers that are being sent
    bool operator==(const WebLimits&) const = default;
};

// An overlay of shapes, such as warnings (web/doors/overlays/served_overlays.h).
struct ConfiguredOverlay {
    std::string name;            // in addresses: letters, digits and "-._"
    std::filesystem::path path;  // a file, or a directory of files
    bool operator==(const ConfiguredOverlay&) const = default;
};

struct WebConfig {
    std::vector<BindAddress> listen = {{"127.0.0.1", 8090}, {"::1", 8090}};
    std::vector<std::string> names;  // host names of this server, in lower case
    std::optional<PublicAddress> public_address;
    std::vector<std::string> trusted_proxies;  // numeric addresses
    std::vector<WebPart> serve = all_parts();  // each once, in the order of WebPart
    std::string bucket = "unidata-nexrad-level2";
    bool cors = false;                  // pages of other servers may read answers
    std::vector<std::string> embed_in;  // origins whose pages may show ours in a frame
    // A station counts as silent if nothing came from it for this long.
    std::chrono::seconds silent{1200};
    retrieve::FreezingLevels freezing;  // for MESH of storm cells
    ThreddsConfig thredds = usual_thredds();
    std::vector<ConfiguredOverlay> overlays;
    WebLimits limits;

    [[nodiscard]] bool serves(WebPart part) const;
    [[nodiscard]] static ThreddsConfig usual_thredds();
    bool operator==(const WebConfig&) const = default;
};

// Reads [web], [web.thredds], [[web.thredds.collection]], [web.limits] and [[overlay]]. Each error
// becomes a complaint of the table.
[[nodiscard]] WebConfig read_web_config(TomlTable& root);

}  // namespace stormcellar::web
