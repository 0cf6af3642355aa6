#include "web/data/raw_files.h"

#include <algorithm>

namespace stormcellar::web {
namespace {

std::chrono::milliseconds distance_of(const RawVolume& volume, UtcTime time) {
    return volume.start > time ? volume.start - time : time - volume.start;
}

}  // namespace

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
