// Writes the variables of a CfRadial file that have one element for each radial.
#include <algorithm>
#include <chrono>
#include <optional>

#include <netcdf.h>

#include "export/cfradial_parts.h"

namespace stormcellar::netcdf {
namespace {

using level2::Radial;
using level2::Sweep;

template <class Value, class Function>
std::vector<Value> of_each_radial(const CfradialParts& parts, Function function) {
    std::vector<Value> values;
    values.reserve(parts.layout.radials);
    for (const Sweep& sweep : parts.sweeps) {
        for (const Radial& radial : sweep.radials)
            values.push_back(function(radial));
    }
    return values;
}

void write_pointing(const CfradialParts& parts) {
    NetcdfBuilder& file = parts.file;
    const auto write = [&](const char* name, const char* standard_name, const char* long_name,
                           const char* axis, const std::vector<float>& values) {
        const int variable = parts.variable(name, NC_FLOAT, {parts.time}, long_name, "degrees");
        file.text(variable, "standard_name", standard_name);
        file.text(variable, "axis", axis);
        file.write(variable, std::span<const float>(values));
    };
    write("azimuth", "ray_azimuth_angle", "azimuth_angle_from_true_north",
          "radial_azimuth_coordinate",
          of_each_radial<float>(parts, [](const Radial& radial) { return radial.azimuth_deg; }));
    write("elevation", "ray_elevation_angle", "elevation_angle_from_horizontal_plane",
          "radial_elevation_coordinate",
          of_each_radial<float>(parts, [](const Radial& radial) { return radial.elevation_deg; }));
}

void write_times(const CfradialParts& parts) {
    const std::string units = "seconds since " + format_utc(parts.reference);
    const int time = parts.variable("time", NC_DOUBLE, {parts.time},
                                    "time_in_seconds_since_volume_start", units.c_str());
    parts.file.text(time, "standard_name", "time");
    parts.file.text(time, "calendar", "standard");
    const auto seconds = of_each_radial<double>(parts, [&](const Radial& radial) {
        return std::chrono::duration<double>(radial.time - parts.reference).count();
    });
    parts.file.write(time, std::span<const double>(seconds));
}

void write_instrument(const CfradialParts& parts) {
    const auto write = [&](const char* name, const char* long_name, const char* units,
                           auto function) {
        const auto values = of_each_radial<Known>(parts, function);
        const int variable = write_known(parts, name, {parts.time}, long_name, units, values);
        if (variable != NetcdfBuilder::file) {
            parts.file.text(variable, "meta_group", "instrument_parameters");
        }
    };
    write("nyquist_velocity", "unambiguous_doppler_velocity", "meters per second",
          [](const Radial& radial) { return unless_zero(radial.nyquist_mps); });
    write("unambiguous_range", "unambiguous_range", "meters",
          [](const Radial& radial) { return unless_zero(radial.unambiguous_range_m); });
    write("radar_measured_sky_noise", "noise of the horizontal channel", "dBm",
          [](const Radial& radial) { return radial.horizontal_noise_dbm; });
    write("radar_measured_sky_noise_v", "noise of the vertical channel", "dBm",
          [](const Radial& radial) { return radial.vertical_noise_dbm; });
    write("calibration_dbz0_h", "reflectivity of the noise at 1 km, horizontal channel", "dBZ",
          [](const Radial& radial) { return radial.calibration_dbz; });
    write("calibration_dbz0_v", "reflectivity of the noise at 1 km, vertical channel", "dBZ",
          [](const Radial& radial) { return radial.vertical_calibration_dbz; });
}

// Writes what Level II says about each radial and CfRadial has no name for.
void write_level2_facts(const CfradialParts& parts) {
    const auto ints = [&](auto function) { return of_each_radial<int>(parts, function); };
    write_ints(parts, "azimuth_number", {parts.time}, "number of the radial in its sweep",
               ints([](const Radial& radial) { return radial.azimuth_number; }));
    write_ints(parts, "radial_status", {parts.time},
               "0 start, 1 inside, 2 end of a sweep, 3 start, 4 end of the volume, 5 start of the "
               "last sweep; 128 more: bad data",
               ints([](const Radial& radial) { return radial.status; }));
    write_ints(parts, "cut_sector", {parts.time}, "sector of the cut",
               ints([](const Radial& radial) { return radial.cut_sector; }));
    write_ints(parts, "spot_blanking", {parts.time},
               "bits: 1 this radial, 2 this sweep, 4 this volume is blanked in part",
               ints([](const Radial& radial) { return radial.spot_blanking; }));
}

}  // namespace

int write_known(const CfradialParts& parts, const char* name, const std::vector<int>& dimensions,
                const char* long_name, const char* units, const std::vector<Known>& values) {
    const auto known = [](const Known& value) { return value.has_value(); };
    if (std::none_of(values.begin(), values.end(), known)) return NetcdfBuilder::file;
    const int variable = parts.variable(name, NC_FLOAT, dimensions, long_name, units);
    parts.file.fill_value(variable, static_cast<double>(NC_FILL_FLOAT));
    std::vector<float> filled;
    filled.reserve(values.size());
    for (const auto& value : values)
        filled.push_back(value.value_or(NC_FILL_FLOAT));
    parts.file.write(variable, std::span<const float>(filled));
    return variable;
}

Known unless_zero(float value) {
    return value == 0 ? std::nullopt : Known{value};
}

void write_ints(const CfradialParts& parts, const char* name, const std::vector<int>& dimensions,
                const char* long_name, const std::vector<int>& values) {
    const int variable = parts.variable(name, NC_INT, dimensions, long_name, "1");
    parts.file.write(variable, std::span<const int>(values));
}

void write_radial_variables(const CfradialParts& parts) {
    write_times(parts);
    write_pointing(parts);
    write_instrument(parts);
    write_level2_facts(parts);
}

}  // namespace stormcellar::netcdf
