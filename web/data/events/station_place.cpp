#include "web/data/events/station_place.h"

namespace stormcellar::web {

std::optional<StationPlace> place_of_station(Grids* grids, std::string_view icao) {
    if (const auto known = find_station(icao)) {
        return StationPlace{
            std::string(known->name), std::string(known->state), known->kind,
            known->latitude_deg,      known->longitude_deg,      known->antenna_altitude_m};
    }
    if (grids == nullptr || !is_icao(icao)) return std::nullopt;
    for (const level2::Moment moment : grids->moments(icao)) {
        const auto newest = grids->newest(icao, moment);
        if (!newest) continue;
        const auto grid = grids->find(icao, moment, *newest);
        if (!grid) continue;
        const auto& sites = (*grid)->file.description().sites;
        // A mosaic may also have a name of four letters, so check that this site alone made the
        // grid.
        if (sites.size() != 1 || sites.front().icao != icao) continue;
        return StationPlace{{},
                            {},
                            {},
                            sites.front().latitude_deg,
                            sites.front().longitude_deg,
                            sites.front().altitude_m};
    }
    return std::nullopt;
}

}  // namespace stormcellar::web
