#include "bench/restamp.h"

#include <cmath>

namespace stormcellar::bench {
namespace {

bool is_legacy(const level2::Volume& volume) {
    return !volume.sweeps.empty() && volume.sweeps.front().message_type == 1;
}

}  // namespace

// The altitude of the feed horn is the sum of both heights. If they were equal, they would be read
// as those of a TDWR, which are not added.
void move_to(const Station& station, level2::VolumeBlock& block) {
    constexpr int tower_m = 20;
    const auto altitude_m = static_cast<int>(std::lround(station.antenna_altitude_m));
    const int above_base_m = altitude_m == 2 * tower_m ? tower_m + 1 : tower_m;
    block.latitude_deg = static_cast<float>(station.latitude_deg);
    block.longitude_deg = static_cast<float>(station.longitude_deg);
    block.tower_height_m = static_cast<std::uint16_t>(above_base_m);
    block.site_height_m = static_cast<std::int16_t>(altitude_m - above_base_m);
}

void move_times(level2::Volume& volume, std::chrono::milliseconds by) {
    if (volume.header) {
        const NexradTime time = nexrad_from_time(volume.header->time() + by);
        volume.header->date = time.day;
        volume.header->ms = time.milliseconds;
    }
    for (level2::Sweep& sweep : volume.sweeps) {
        for (level2::Radial& radial : sweep.radials) {
            if (level2::is_plausible(radial.time)) radial.time += by;
        }
    }
}

void restamp(level2::Volume& volume, const Station& station, UtcTime start) {
    if (const auto starts = volume.start_time()) move_times(volume, start - *starts);
    const NexradTime time = nexrad_from_time(start);
    if (!volume.header || volume.header->icao.empty()) {
        volume.header.emplace();
        volume.header->filename = is_legacy(volume) ? "AR2V0001.001" : "AR2V0006.001";
    }
    volume.header->date = time.day;
    volume.header->ms = time.milliseconds;
    volume.header->icao = station.icao;
    volume.station = station.icao;
    if (volume.block) move_to(station, *volume.block);
}

}  // namespace stormcellar::bench
