#include "daemon/config/station_config.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/printable.h"

namespace stormcellar::daemon {
namespace {

constexpr std::size_t most_added = 512;

std::string no_station(const std::string& name) {
    return fmt::format(
        "\"{}\" is not a station: give four capital letters or digits, as in \"KTLX\"",
        printable(name));
}

StationRule read_list(TomlTable& ingest) {
    const auto names = ingest.texts("stations");
    if (!names) return {};
    if (names->empty()) ingest.complain("stations", "must name a station, or be left out");
    for (const std::string& name : *names)
        if (!is_icao(name)) ingest.complain("stations", no_station(name));
    return StationRule::listed(*names);
}

void read_place(TomlTable& table, AddedStation& station) {
    const auto need = [&](std::string_view key, TomlRange range, double& value) {
        if (const auto given = table.number(key, range)) {
            value = *given;
        } else if (!table.has(key)) {
            table.complain(key, "must be given");
        }
    };
    need("latitude_deg", {-90, 90}, station.latitude_deg);
    need("longitude_deg", {-180, 180}, station.longitude_deg);
    need("antenna_altitude_m", {-500, 9000}, station.antenna_altitude_m);
}

}  // namespace

StationRule read_station_rule(TomlTable& ingest) {
    if (ingest.is_array("stations")) return read_list(ingest);
    const auto name = ingest.text("stations");
    if (!name || *name == "known") return {};
    if (*name == "any") return StationRule::any();
    ingest.complain("stations", fmt::format("\"{}\" must be known, any or a list of stations",
                                            printable(*name)));
    return {};
}

std::string_view name_of(StationRule::Kind kind) {
    switch (kind) {
        case StationRule::Kind::known:
            return "known";
        case StationRule::Kind::any:
            return "any";
        case StationRule::Kind::listed:
            return "listed";
    }
    return "known";
}

std::vector<AddedStation> read_added_stations(TomlTable& root) {
    std::vector<AddedStation> stations;
    for (TomlTable& table : root.tables("station")) {
        AddedStation station;
        const auto icao = table.text("icao");
        if (!icao) {
            if (!table.has("icao")) table.complain("icao", "must be given");
        } else if (!is_icao(*icao)) {
            table.complain("icao", no_station(*icao));
        } else if (std::ranges::any_of(all_stations(),
                                       [&](const Station& one) { return one.icao == *icao; })) {
            table.complain("icao", fmt::format("{} is already in the station table", *icao));
        } else if (std::ranges::any_of(
                       stations, [&](const AddedStation& one) { return one.icao == *icao; })) {
            table.complain("icao", fmt::format("{} is named twice", *icao));
        } else {
            station.icao = *icao;
        }
        station.name = table.text("name").value_or("");
        read_place(table, station);
        if (stations.size() == most_added) {
            table.complain("icao", fmt::format("at most {} stations can be added", most_added));
            break;
        }
        if (!station.icao.empty()) stations.push_back(std::move(station));
    }
    return stations;
}

}  // namespace stormcellar::daemon
