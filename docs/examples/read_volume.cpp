// Reads a Level II file and prints the place of the strongest echo of each sweep.
#include <cstdio>

#include <stormcellar/level2/decode.h>

using namespace stormcellar;

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: read_volume FILE\n");
        return 2;
    }
    level2::DecodeOptions options;
    options.selection.moments = {level2::Moment::ref};  // other moments are not unpacked
    const auto decoded = level2::decode_file(argv[1], options);
    if (!decoded) {
        std::fprintf(stderr, "%s\n", decoded.error().message.c_str());
        return 1;
    }
    const level2::Volume& volume = decoded->volume;
    std::printf("%s, %s\n", volume.station.c_str(),
                decoded->report.complete ? "complete" : "not complete");
    for (const level2::Sweep& sweep : volume.sweeps) {
        const level2::SweepMoment* reflectivity = sweep.find(level2::Moment::ref);
        if (reflectivity == nullptr) continue;
        float strongest_dbz = -100;
        double azimuth_deg = 0, range_m = 0;
        for (std::size_t radial = 0; radial < sweep.radials.size(); ++radial) {
            for (int gate = 0; gate < reflectivity->gate_counts[radial]; ++gate) {
                // Not every gate has a value: it may be below threshold or range folded.
                if (reflectivity->status(radial, gate) != level2::GateStatus::valid) continue;
                const float dbz = reflectivity->value_of(reflectivity->code(radial, gate));
                if (dbz <= strongest_dbz) continue;
                strongest_dbz = dbz;
                azimuth_deg = sweep.radials[radial].azimuth_deg;
                range_m = reflectivity->range_m(gate);
            }
        }
        std::printf("elevation %5.2f degrees: %5.1f dBZ at azimuth %5.1f degrees, range %5.1f km\n",
                    sweep.mean_elevation_deg(), strongest_dbz, azimuth_deg, range_m / 1000);
    }
    return 0;
}
