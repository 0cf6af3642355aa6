// Does what the storage-broker client of the 2008 paper did, under its names: lists the files of
// each station of a catalog in a period, names the oldest file, and gets and reads each file.
#include <cstdio>

#include <stormcellar/catalog/radar_set.h>

using namespace stormcellar;

namespace {

// Calls buildDataList, getOldestFileName, getRadarFile and readRadar, one after another.
Status use(const catalog::RadarSet& radar, UtcTime from, UtcTime to) {
    const auto oldest = radar.oldest_file_name();
    if (!oldest) return tl::unexpected(oldest.error());
    const auto names = radar.build_data_list(from, to);
    if (!names) return tl::unexpected(names.error());
    std::printf("%s  oldest file %s, in the period %zu\n", radar.station().c_str(), oldest->c_str(),
                names->size());
    for (const std::string& name : *names) {
        // These are the bytes as they arrived, compressed or not.
        const auto bytes = radar.radar_file(name);
        if (!bytes) return tl::unexpected(bytes.error());
        const auto decoded = radar.read_radar(name);
        if (!decoded) return tl::unexpected(decoded.error());
        std::printf("  %s  %zu bytes, %zu sweeps, %zu radials\n", name.c_str(), bytes->size(),
                    decoded->volume.sweeps.size(), decoded->volume.radial_count());
    }
    return {};
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 4) {
        std::fprintf(stderr, "usage: radar_set CATALOG FROM TO\n");
        return 2;
    }
    // "2022-03-17T00:08:42Z", or "-1h" before now.
    const auto from = parse_utc(argv[2], now_utc());
    const auto to = parse_utc(argv[3], now_utc());
    if (!from || !to) {
        std::fprintf(stderr, "%s\n", (from ? to : from).error().message.c_str());
        return 2;
    }
    // There is one object for each station.
    const auto radars = catalog::RadarSet::open_all(argv[1]);
    if (!radars) {
        std::fprintf(stderr, "%s\n", radars.error().message.c_str());
        return 1;
    }
    for (const catalog::RadarSet& radar : *radars) {
        if (const Status used = use(radar, *from, *to); !used) {
            std::fprintf(stderr, "%s: %s\n", radar.station().c_str(), used.error().message.c_str());
            return 1;
        }
    }
    return 0;
}
