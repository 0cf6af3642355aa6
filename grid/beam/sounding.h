// grid/beam/sounding.h -- reads a refractivity profile from a sounding, a text file with one line
// for each level.
//
// Format    UTF-8 (with or without a byte order mark) or ASCII, of at most 1 MiB. Lines end with LF
//           or CR LF. Empty lines, and anything after a #, are skipped. The first remaining line
//           names the columns. Each later line has one number for each column; commas separate the
//           numbers, and blanks and tabs may be around them. Columns may be in any order; columns
//           whose names are not listed below are skipped. docs/geometry.md shows an example. The
//           file needs
//             height_m             above mean sea level, strictly rising, the first at most 9,000 m
//           and either
//             refractivity         N-units, above 0 and at most 1000
//           or all of
//             pressure_hpa         above 0 and at most 1100, never rising
//             temperature_c        -120 to 60
//             dew_point_c          -150 to 40, not above the temperature; with respect to water
//             or relative_humidity_percent   0 to 100, with respect to water
// Source    N = 77.6 p / T + 3.73e5 e / T^2, and the saturation pressure over water: ITU-R P.453-7
//           eqs 2-6 (within 0.5 % up to 100 GHz).
// Threads   Pure functions; read_sounding() reads a file.
// Errors    bad_argument, with the file, line and column; those of reading the file, such as
//           not_found and io.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "stormcellar/base/result.h"
#include "stormcellar/grid/refractivity.h"

namespace stormcellar::grid {

// Returns the refractivity of air at a pressure, a temperature and a dew point.
[[nodiscard]] double refractivity(double pressure_hpa, double temperature_c, double dew_point_c);
// Returns the saturation pressure of vapor over water, in hPa.
[[nodiscard]] double saturation_pressure_hpa(double temperature_c);

// Reads a file. The name of the profile is "sounding NAME", where NAME has no directory.
[[nodiscard]] Result<RefractivityProfile> read_sounding(const std::filesystem::path& file);
// Parses a text. `name` is used in messages and in the name of the profile.
[[nodiscard]] Result<RefractivityProfile> parse_sounding(std::string_view text,
                                                         const std::string& name);

}  // namespace stormcellar::grid
