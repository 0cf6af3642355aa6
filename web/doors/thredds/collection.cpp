#include "web/doors/thredds/collection.h"

#include <algorithm>

#include "stormcellar/base/station_table.h"

namespace stormcellar::web {
namespace {

std::optional<Station> station_of_id(std::string_view id) {
    if (auto known = find_station(id)) return known;
    if (id.size() != 3) return std::nullopt;
    // Level III drops the first letter of a station. It is K in most states, P in the Pacific, and
    // T for terminal radars.
    for (const char* first : {"K", "P", "T"}) {
        if (auto known = find_station(first + std::string{id})) return known;
    }
    return std::nullopt;
}

// Sets the state or the country. The table has two letters for a state of the United States, and
// the country's name for other places.
void set_state(ThreddsStation& station, std::string_view state) {
    constexpr std::size_t letters_of_state = 2;
    const bool is_state = state.size() == letters_of_state;
    if (is_state) station.state = state;
    if (!state.empty()) station.country = is_state ? "US" : std::string{state};
}

// Copies the place of a ConfiguredPlace or a RawStation.
template <class Place>
void set_place(ThreddsStation& station, const Place& place) {
    station.name = place.name;
    set_state(station, place.state);
    station.has_place = true;
    station.latitude_deg = place.latitude_deg;
    station.longitude_deg = place.longitude_deg;
    station.altitude_m = place.altitude_m;
}

ThreddsStation thredds_station(std::string_view id, const std::vector<ConfiguredPlace>& places) {
    ThreddsStation station;
    station.id = id;
    const auto place = std::ranges::find(places, id, &ConfiguredPlace::id);
    if (place != places.end()) {
        set_place(station, *place);
        return station;
    }
    const auto known = station_of_id(id);
    if (!known) return station;
    station.name = known->name;
    set_state(station, known->state);
    station.has_place = true;
    station.latitude_deg = known->latitude_deg;
    station.longitude_deg = known->longitude_deg;
    station.altitude_m = known->antenna_altitude_m;
    return station;
}

}  // namespace

Result<std::vector<ThreddsStation>> ThreddsCollection::stations() {
    std::vector<std::string> ids = configured_.stations;
    if (ids.empty()) {
        auto all = station_ids();
        if (!all) return pass_on(all);
        ids = std::move(*all);
    }
    std::vector<ThreddsStation> stations;
    for (const std::string& id : ids)
        stations.push_back(thredds_station(id, places_));
    if (std::ranges::all_of(stations, &ThreddsStation::has_place)) return stations;
    const std::vector<RawStation> placed = placed_by_files();
    for (ThreddsStation& station : stations) {
        if (station.has_place) continue;
        const auto own = std::ranges::lower_bound(placed, station.id, {}, &RawStation::icao);
        if (own != placed.end() && own->icao == station.id) set_place(station, *own);
    }
    return stations;
}

std::shared_ptr<ThreddsCollection> make_collection(const ConfiguredCollection& configured,
                                                   const std::vector<ConfiguredPlace>& places,
                                                   std::shared_ptr<RawFiles> files) {
    return configured.variables.empty()
               ? make_level2_collection(configured, places, std::move(files))
               : make_level3_collection(configured, places);
}

}  // namespace stormcellar::web
