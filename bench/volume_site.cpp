#include "bench/volume_site.h"

#include "stormcellar/base/station_table.h"

namespace stormcellar::bench {

Result<grid::SitePosition> site_of(const level2::Volume& volume) {
    if (const auto antenna = level2::antenna_position(volume)) {
        return grid::SitePosition{volume.station, antenna->latitude_deg, antenna->longitude_deg,
                                  antenna->altitude_m};
    }
    if (const auto station = find_station(volume.station)) {
        return grid::SitePosition{volume.station, station->latitude_deg, station->longitude_deg,
                                  station->antenna_altitude_m};
    }
    return fail(ErrorCode::not_found, "no position");
}

}  // namespace stormcellar::bench
