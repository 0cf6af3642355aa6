#include "base/added_stations.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "base/printable.h"

namespace stormcellar {
namespace {

constexpr std::size_t most_added = 512;

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

std::string no_station(const std::string& name) {
    return fmt::format(
        "\"{}\" is not a station: give four capital letters or digits, as in \"KTLX\"",
        printable(name));
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

}  // namespace stormcellar
