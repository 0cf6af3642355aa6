// grid/beam/sounding.h -- a refractivity profile from a sounding, a text file with a line a level.
//
// Format (docs/geometry.md shows one)
//   UTF-8 (with or without a byte order mark) or ASCII of at most 1 MiB; lines end with LF or CR
//   LF; empty lines and what follows a # are skipped. The first line left names the columns, the
//   others hold as many numbers; commas between them, blanks and tabs around them are skipped.
//   Columns stand in any order; those of other names are skipped. Needed are
//     height_m             above mean sea level, strictly rising, the first at most 9,000 m
//   and either
//     refractivity         N-units, above 0 and at most 1000
//   or all of
//     pressure_hpa         above 0 and at most 1100, never rising
//     temperature_c        -120 to 60
//     dew_point_c          -150 to 40, not above the temperature; with respect to water
//     or relative_humidity_percent   0 to 100, with respect to water
// Source  N = 77.6 p / T + 3.73e5 e / T^2 and the saturation pressure over water: ITU-R P.453-7
//         eqs 2-6 (within 0.5 % up to 100 GHz).
// Errors  bad_argument, naming file, line and column; not_found, io ... from reading the file.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "stormcellar/base/result.h"
#include "stormcellar/grid/refractivity.h"

namespace stormcellar::grid {

// Of air at a pressure, a temperature and a dew point.
[[nodiscard]] double refractivity(double pressure_hpa, double temperature_c, double dew_point_c);
// Of vapour over water, in hPa.
[[nodiscard]] double saturation_pressure_hpa(double temperature_c);

// The profile's name is "sounding NAME", without the directory.
[[nodiscard]] Result<RefractivityProfile> read_sounding(const std::filesystem::path& file);
// `name` stands for the file in messages and in the profile's name.
[[nodiscard]] Result<RefractivityProfile> parse_sounding(std::string_view text,
                                                         const std::string& name);

}  // namespace stormcellar::grid
