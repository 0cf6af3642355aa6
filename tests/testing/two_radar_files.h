// tests/testing/two_radar_files.h -- writes the volumes of tests/testing/two_radars.h as Level II
// files.
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "stormcellar/base/file_system.h"
#include "stormcellar/level2/encode.h"
#include "synth/observe.h"
#include "tests/testing/two_radars.h"

namespace stormcellar::testing {

// Writes two volumes each of XSYA and XSYB, five minutes apart. XSYB's reflectivity is too weak by
// `b_too_weak_db`. Returns the files in order of time. Throws if writing fails.
inline std::vector<std::filesystem::path> write_two_radars(const std::filesystem::path& directory,
                                                           float b_too_weak_db) {
    struct Place {
        const char* station;
        double longitude_deg;
        float weak_db;
    };
    std::vector<std::filesystem::path> files;
    for (const int number : {0, 1}) {
        for (const Place& place : {Place{"XSYA", -97.6, 0}, Place{"XSYB", -96.4, b_too_weak_db}}) {
            const auto scene = synth::parse_scene(
                scene_of_nine_storms(place.station, place.longitude_deg, place.station[3], 2),
                place.station);
            if (!scene) throw std::runtime_error(scene.error().message);
            level2::Volume volume = synth::observe(*scene, number);
            for (level2::Sweep& sweep : volume.sweeps) {
                for (level2::SweepMoment& moment : sweep.moments)
                    moment.offset += place.weak_db * moment.scale;
            }
            const auto encoded = level2::encode(volume);
            if (!encoded) throw std::runtime_error(encoded.error().message);
            files.push_back(directory /
                            fmt::format("{}20240601_220{}00_V06", place.station, 5 * number));
            const auto written =
                write_file_atomically(real_file_system(), files.back(), encoded->joined());
            if (!written) throw std::runtime_error(written.error().message);
        }
    }
    return files;
}

}  // namespace stormcellar::testing
