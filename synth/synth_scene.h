// synth/synth_scene.h -- describes the input of a simulated radar: one site, its schedule and the
// weather.
//
// A scene is read from TOML. docs/scenes.md has every key with its unit and its default.
//
// Units     Each member names its unit.
// Threads   Plain data and pure functions.
// Errors    bad_argument, with the file, the line and the key; and those of reading the file.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "stormcellar/base/result.h"
#include "stormcellar/base/utc_time.h"
#include "synth/instrument.h"
#include "synth/truth.h"
#include "synth/vcp.h"

namespace stormcellar::synth {

struct Site {
    std::string station;  // ICAO; part of the file names
    double latitude_deg = 0;
    double longitude_deg = 0;
    int antenna_altitude_m = 0;  // whole meters, as in message 31
};

struct Schedule {
    int count = 1;
    UtcTime start;            // of the first volume; the time t of the weather is 0 then
    double interval_s = 300;  // from one start to the next; not shorter than the pattern takes
    Pattern pattern;

    [[nodiscard]] UtcTime start_of(int volume) const;
};

struct Scene {
    Site site;
    Schedule schedule;
    Weather weather;  // in the plane about the site, even if the file has another origin
    Instrument instrument;
};

// Returns the place of a radar in the plane of weather that has its origin at this position. So two
// scenes with the same origin describe two radars that see the same weather.
[[nodiscard]] Stand stand_of(const Site& site, double latitude_deg, double longitude_deg);

// Parses a scene. `name` is the file's name in messages.
[[nodiscard]] Result<Scene> parse_scene(std::string_view toml, const std::string& name);
[[nodiscard]] Result<Scene> read_scene(const std::filesystem::path& path);

}  // namespace stormcellar::synth
