#include "web/data/raw/raw_files.h"

#include <algorithm>

#include "web/data/events/station_place.h"

namespace stormcellar::web {
namespace {

std::chrono::milliseconds distance_of(const RawVolume& volume, UtcTime time) {
    return volume.start > time ? volume.start - time : time - volume.start;
}

}  // namespace

RawStation raw_station(std::string_view icao, Grids* grids) {
    RawStation station;
    station.icao = icao;
    const auto known = place_of_station(grids, icao);
    if (!known) return station;
    station.name = known->name;
    station.state = known->state;
    station.has_place = true;
    station.latitude_deg = known->latitude_deg;
    station.longitude_deg = known->longitude_deg;
    station.altitude_m = known->antenna_altitude_m;
    return station;
}

Result<std::optional<RawVolume>> RawFiles::nearest(std::string_view station, UtcTime time,
                                                   std::chrono::milliseconds within) {
    RawRange before;
    before.from = time - within;
    before.to = time;
    before.most = 1;
    before.newest_first = true;
    RawRange after;
    after.from = time;
    after.to = time + within;
    after.most = 1;
    std::optional<RawVolume> found;
    for (const RawRange& side : {before, after}) {
        const auto volumes = list(station, side);
        if (!volumes) return pass_on(volumes);
        for (const RawVolume& volume : *volumes) {
            if (!found || distance_of(volume, time) < distance_of(*found, time)) found = volume;
        }
    }
    return found;
}

Result<std::optional<RawVolume>> RawFiles::latest(std::string_view station) {
    RawRange newest;
    newest.to = now_utc() + tolerated_future;
    newest.most = 1;
    newest.newest_first = true;
    const auto volumes = list(station, newest);
    if (!volumes) return pass_on(volumes);
    return volumes->empty() ? std::nullopt : std::optional{volumes->front()};
}

}  // namespace stormcellar::web
