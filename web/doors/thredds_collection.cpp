#include "web/doors/thredds_collection.h"

#include "stormcellar/base/station_table.h"

namespace stormcellar::web {
namespace {

std::optional<Station> station_of_id(std::string_view id) {
    if (auto known = find_station(id)) return known;
    if (id.size() != 3) return std::nullopt;
    // Level III drops the first letter: K in most states, P in the Pacific, T for terminal radars.
    for (const char* first : {"K", "P", "T"}) {
        if (auto known = find_station(first + std::string{id})) return known;
    }
    return std::nullopt;
}

}  // namespace

ThreddsStation thredds_station(std::string_view id) {
    ThreddsStation station;
    station.id = id;
    const auto known = station_of_id(id);
    if (!known) return station;
    station.name = known->name;
    // The table has two letters for states and the name of any other country.
    constexpr std::size_t letters_of_state = 2;
    const bool has_state = known->state.size() == letters_of_state;
    if (has_state) station.state = known->state;
    if (!known->state.empty()) station.country = has_state ? "US" : std::string{known->state};
    station.has_place = true;
    station.latitude_deg = known->latitude_deg;
    station.longitude_deg = known->longitude_deg;
    station.altitude_m = known->antenna_altitude_m;
    return station;
}

Result<std::vector<ThreddsStation>> ThreddsCollection::stations() {
    std::vector<std::string> ids = configured_.stations;
    if (ids.empty()) {
        auto all = station_ids();
        if (!all) return pass_on(all);
        ids = std::move(*all);
    }
    std::vector<ThreddsStation> stations;
    for (const std::string& id : ids)
        stations.push_back(thredds_station(id));
    return stations;
}

std::shared_ptr<ThreddsCollection> make_collection(const ConfiguredCollection& configured,
                                                   std::shared_ptr<RawFiles> files) {
    const bool is_level3 = !configured.variables.empty() || !configured.files.empty();
    return is_level3 ? make_level3_collection(configured)
                     : make_level2_collection(configured, std::move(files));
}

}  // namespace stormcellar::web
