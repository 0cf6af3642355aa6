#include "daemon/config/station_config.h"

#include <fmt/format.h>

#include "base/added_stations.h"
#include "base/printable.h"

namespace stormcellar::daemon {
namespace {

StationRule read_list(TomlTable& ingest) {
    const auto names = ingest.texts("stations");
    if (!names) return {};
    if (names->empty()) ingest.complain("stations", "must name a station, or be left out");
    for (const std::string& name : *names)
        if (!is_icao(name)) ingest.complain("stations", no_station(name));
    return StationRule::listed(*names);
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
    if (kind == StationRule::Kind::any) return "any";
    return kind == StationRule::Kind::listed ? "listed" : "known";
}

}  // namespace stormcellar::daemon
