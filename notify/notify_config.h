// notify/notify_config.h -- reads the tables [notify] and [[notify.rule]] of stormcellard.toml.
//
// Units     As the ends of the names say: km, dBZ, kg/m^2, mm.
// Threads   Plain data and a pure function.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/retrieve/hail.h"

namespace stormcellar::notify {

// A topic of an MQTT broker, "mqtt://HOST:PORT/TOPIC", or with TLS "mqtts://HOST:PORT/TOPIC".
struct MqttAddress {
    std::string host;
    int port = 1883;  // with TLS, the default is 8883
    std::string topic;
    bool tls = false;
    bool operator==(const MqttAddress&) const = default;
};

// Least values of a cell. A cell passes if it reaches all of the values that are given.
struct Thresholds {
    std::optional<double> max_dbz = {}, vil_kg_per_m2 = {}, mesh_mm = {}, top_km = {};
    bool operator==(const Thresholds&) const = default;
};

// Cells of `area` that pass the thresholds within `radius_km` of the place are sent to `url` or to
// `mqtt`.
struct NotifyRule {
    std::string name = {};  // also the name of the directory of its messages
    std::string area = {};  // the station or domain whose REF grids are read
    double latitude_deg = 0, longitude_deg = 0;
    double radius_km = 0;
    Thresholds thresholds = {};
    std::chrono::seconds every{std::chrono::minutes{15}};  // between two messages about one cell
    std::string url = {};                                  // empty: send to `mqtt`
    MqttAddress mqtt = {};
    std::filesystem::path password_file = {};  // of the broker, with "USER:PASSWORD"; empty: none
    bool operator==(const NotifyRule&) const = default;
};

struct NotifyConfig {
    std::filesystem::path cache = "/var/cache/stormcellar";  // [paths] cache
    std::filesystem::path directory = "/var/lib/stormcellar-notify";
    retrieve::FreezingLevels freezing;  // for MESH
    std::vector<NotifyRule> rules;
    std::string log_level = "info";  // debug, info, warning or error
    bool operator==(const NotifyConfig&) const = default;
};

// Loads the configuration. Relative paths start at the directory of the file. Ignores the tables of
// other programs. Errors: those of reading the file; bad_argument, "FILE:LINE: [section] key: why".
[[nodiscard]] Result<NotifyConfig> load_notify_config(const std::filesystem::path& file);

}  // namespace stormcellar::notify
