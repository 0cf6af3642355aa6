// tests/testing/two_radars.h -- scenes of simulated radars that look at the same storms.
//
// Nine storms about 35 N 97 W move in one direction at 26 m/s. The noise of reflectivity is 1 dB.
// The radars are at 35 N, 97.6 W and 96.4 W, 110 km apart. A volume takes 160 s.
#pragma once

#include <string>

#include <fmt/format.h>

namespace stormcellar::testing {

inline constexpr double storms_east_mps = 24;
inline constexpr double storms_north_mps = 9;

// Returns the scene as text (docs/scenes.md), with a volume every five minutes from
// 2024-06-01T22:00:00Z.
inline std::string scene_of_nine_storms(const char* station, double longitude_deg, unsigned seed,
                                        int volumes = 1) {
    std::string text = fmt::format(R"([radar]
station = "{}"
latitude_deg = 35
longitude_deg = {}
altitude_m = 380
[weather]
latitude_deg = 35
longitude_deg = -97
[volumes]
count = {}
start = "2024-06-01T22:00:00Z"
[instrument]
seed = {}
noise_db = 1
)",
                                   station, longitude_deg, volumes, seed);
    for (const double elevation_deg : {0.5, 1.3, 2.2, 3.1, 4.2, 5.6, 7.4, 9.8}) {
        text += fmt::format(
            "[[cut]]\nelevation_deg = {}\nazimuth_rate_deg_s = 18\nwaveform = \"surveillance\"\n",
            elevation_deg);
    }
    struct Place {
        double x_km, y_km, size_km, top_km;
    };
    for (const Place& place :
         {Place{-95, 60, 16, 13}, Place{-60, -75, 18, 14}, Place{-8, 70, 15, 12},
          Place{2, -10, 14, 13}, Place{50, -80, 17, 14}, Place{85, 50, 16, 12},
          Place{5, -130, 15, 13}, Place{10, 125, 17, 14}, Place{-40, 20, 13, 11}}) {
        text += fmt::format(
            "[[storm]]\nposition_km = [{}, {}]\nvelocity_mps = [{}, {}]\nradii_km = [{}, {}]\n"
            "orientation_deg = 40\ncore_km = 3\ntop_km = {}\npeak_dbz = 55\ntilt = [0.4, 0.3]\n"
            "ripple_db = 5\nripple_length_km = 9\n",
            place.x_km, place.y_km, storms_east_mps, storms_north_mps, place.size_km,
            0.75 * place.size_km, place.top_km);
    }
    return text;
}

}  // namespace stormcellar::testing
