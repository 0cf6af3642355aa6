// tests/level2/foreign/cfradial_files.h -- small files of CfRadial.
#pragma once

#include <string>
#include <vector>

#include "tests/level2/foreign/netcdf_writer.h"

namespace stormcellar::testing {

// Writes the coordinates of `rays` rays and three gates of 150 m: two sweeps of half the rays each,
// at 1 and 2 degrees.
inline void write_coordinates(NetcdfWriter& file, std::size_t rays, double elevation_deg = 1) {
    std::vector<double> times_s;
    std::vector<float> azimuths_deg;
    std::vector<float> elevations_deg;
    for (std::size_t i = 0; i < rays; ++i) {
        times_s.push_back(0.25 * static_cast<double>(i));
        azimuths_deg.push_back(static_cast<float>(i * 40));
        elevations_deg.push_back(static_cast<float>(elevation_deg + (2 * i >= rays ? 1 : 0)));
    }
    file.array("time", {"time"}, times_s);
    file.text("time", "units", "seconds since 2018-11-10T12:00:00Z");
    file.array("azimuth", {"time"}, azimuths_deg);
    file.array("elevation", {"time"}, elevations_deg);
    file.array("range", {"range"}, std::vector<float>{75, 225, 375});
}

// Begins a file of CfRadial 1 of the radar CHIVO in Argentina, with four rays in two sweeps.
inline void begin_cfradial(NetcdfWriter& file, std::size_t time_size = 4) {
    file.text("", "Conventions", "CF/Radial instrument_parameters");
    file.text("", "version", "1.3");
    file.text("", "instrument_name", "CHIVO");
    file.dimension("time", time_size);
    file.dimension("range", 3);
    file.dimension("sweep", 2);
    file.dimension("string_length", 22);
    file.array("latitude", {}, std::vector<double>{-31.63});
    file.array("longitude", {}, std::vector<double>{-64.17});
    file.array("altitude", {}, std::vector<double>{478.4});
    write_coordinates(file, 4);
    file.array("sweep_start_ray_index", {"sweep"}, std::vector<int>{0, 2});
    file.array("sweep_end_ray_index", {"sweep"}, std::vector<int>{1, 3});
    file.array("fixed_angle", {"sweep"}, std::vector<float>{1, 2});
    file.array("nyquist_velocity", {"time"}, std::vector<float>{10, 10, 12, 12});
}

}  // namespace stormcellar::testing
