// tests/testing/small_sequence.h -- five volumes of a simulated radar. Tests that need no
// particular values use this sequence, so that they run without the real volumes.
//
// The radar is KBGM, which sees one storm in three sweeps. The volumes have nearly the same times
// as the real volumes of sequence-kbgm.
#pragma once

#include <array>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "stormcellar/base/file_system.h"
#include "stormcellar/base/utc_time.h"
#include "stormcellar/level2/encode.h"
#include "synth/observe.h"

namespace stormcellar::testing {

inline constexpr std::array small_sequence = {"KBGM20050822_024414_V06", "KBGM20050822_025001_V06",
                                              "KBGM20050822_025549_V06", "KBGM20050822_030243_V06",
                                              "KBGM20050822_030830_V06"};

// Writes a volume to `file`. The volume's `name` gives the time of its start. Throws if writing
// fails.
inline void write_small_volume(const std::string& name, const std::filesystem::path& file) {
    std::string text = fmt::format(
        "[radar]\nstation = \"KBGM\"\n[volumes]\ncount = 1\nstart = \"{}-{}-{}T{}:{}:{}Z\"\n",
        name.substr(4, 4), name.substr(8, 2), name.substr(10, 2), name.substr(13, 2),
        name.substr(15, 2), name.substr(17, 2));
    for (const double elevation_deg : {0.5, 1.5, 3.0}) {
        text += fmt::format(
            "[[cut]]\nelevation_deg = {}\nazimuth_rate_deg_s = 4\nwaveform = \"batch\"\n",
            elevation_deg);
    }
    text +=
        "[[storm]]\nposition_km = [40, 30]\nvelocity_mps = [15, 5]\nradii_km = [25, 20]\n"
        "core_km = 3\ntop_km = 12\npeak_dbz = 55\n";
    const auto scene = synth::parse_scene(text, name);
    if (!scene) throw std::runtime_error(scene.error().message);
    const auto encoded = level2::encode(synth::observe(*scene, 0));
    if (!encoded) throw std::runtime_error(encoded.error().message);
    const auto written = write_file_atomically(real_file_system(), file, encoded->joined());
    if (!written) throw std::runtime_error(written.error().message);
}

// Writes the first `count` volumes of the sequence into the directory, and returns their files.
// Throws if writing fails, or if the sequence is shorter.
inline std::vector<std::string> write_small_volumes(std::size_t count,
                                                    const std::filesystem::path& directory) {
    std::vector<std::string> files;
    for (std::size_t i = 0; i < count; ++i) {
        const std::string name = small_sequence.at(i);
        files.push_back(directory / name);
        write_small_volume(name, files.back());
    }
    return files;
}

}  // namespace stormcellar::testing
