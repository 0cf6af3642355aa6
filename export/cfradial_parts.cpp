// Writes the parts of a CfRadial file that its versions 1.4 and 2 share.
#include "export/cfradial_parts.h"

#include <array>

#include <netcdf.h>

#include "base/printable.h"
#include "export/volume_facts.h"
#include "stormcellar/base/station_table.h"
#include "stormcellar/base/version.h"

namespace stormcellar::netcdf {

using level2::Volume;

int described_variable(NetcdfBuilder& file, const char* name, int type,
                       const std::vector<int>& dimensions, const char* long_name,
                       const char* units) {
    const int made = file.variable(name, type, dimensions);
    file.text(made, "long_name", long_name);
    if (units != nullptr) file.text(made, "units", units);
    return made;
}

int CfradialParts::variable(const char* name, int type, const std::vector<int>& dimensions,
                            const char* long_name, const char* units) const {
    return described_variable(file, name, type, dimensions, long_name, units);
}

void write_titles(NetcdfBuilder& file, const Volume& volume, const VolumeWriteOptions& options,
                  UtcTime reference, const CfradialVersion& version) {
    constexpr int global = NetcdfBuilder::file;
    const auto station = find_station(volume.station);
    const std::string name = volume.station.empty() ? "unknown" : printable(volume.station);
    const std::string source = printable(options.source_file);
    const std::string software = fmt::format("stormcellar {}", software_version);
    file.text(global, "Conventions", version.conventions);
    file.text(global, "version", version.version);
    file.text(global, "title", fmt::format("Radar volume of {}, {}", name, format_utc(reference)));
    file.text(global, "institution", institution_of(station));
    file.text(global, "references",
              fmt::format("NEXRAD ICD 2620002 (RDA/RPG) and 2620010 (Archive II/User); {}",
                          version.standard));
    file.text(global, "source", "weather radar Level II volume");
    file.text(global, "history",
              source.empty() ? software + ": decoded"
                             : fmt::format("{}: decoded from {}", software, source));
    file.text(global, "comment", version.comment);
    file.text(global, "instrument_name", name);
    file.text(global, "site_name",
              station ? fmt::format("{}, {}", station->name, station->state) : "unknown");
    if (!source.empty()) file.text(global, "source_file", source);
    file.text(global, "software_version", software);
    file.text(global, "volume", options.complete ? "complete" : "partial");
}

void write_power_attributes(NetcdfBuilder& file, const Volume& volume) {
    constexpr int global = NetcdfBuilder::file;
    if (!volume.block) return;
    const level2::VolumeBlock& block = *volume.block;
    file.number(global, "transmitter_power_h_kw", static_cast<double>(block.horizontal_power_kw));
    file.number(global, "transmitter_power_v_kw", static_cast<double>(block.vertical_power_kw));
    file.number(global, "reflectivity_calibration_db", static_cast<double>(block.calibration_db));
    file.number(global, "system_zdr_db", static_cast<double>(block.differential_reflectivity_db));
    file.number(global, "system_phi_deg",
                static_cast<double>(block.initial_differential_phase_deg));
}

void write_volume_number(NetcdfBuilder& file, const Volume& volume) {
    const auto number = volume.header ? volume.header->volume_number() : std::nullopt;
    const int variable =
        described_variable(file, "volume_number", NC_INT, {}, "data_volume_index_number", "1");
    constexpr int unknown = -1;
    if (!number) file.fill_value(variable, unknown);
    file.write(variable, std::array<int, 1>{number.value_or(unknown)});
}

void write_position(NetcdfBuilder& file, const Volume& volume) {
    const auto antenna = level2::antenna_position(volume);
    const auto write = [&](const char* name, const char* units, std::optional<double> value) {
        const int variable = described_variable(file, name, NC_DOUBLE, {}, name, units);
        file.text(variable, "standard_name", name);
        if (!value) file.fill_value(variable, NC_FILL_DOUBLE);
        file.write(variable, std::array<double, 1>{value.value_or(NC_FILL_DOUBLE)});
        return variable;
    };
    using Degrees = std::optional<double>;
    write("latitude", "degrees_north", antenna ? Degrees{antenna->latitude_deg} : std::nullopt);
    write("longitude", "degrees_east", antenna ? Degrees{antenna->longitude_deg} : std::nullopt);
    const int altitude =
        write("altitude", "meters", antenna ? Degrees{antenna->altitude_m} : std::nullopt);
    file.text(altitude, "positive", "up");
    file.text(altitude, "comment", "of the antenna, above mean sea level");
    if (!antenna) return;
    file.text(NetcdfBuilder::file, "position_source",
              antenna->from_table ? "station table" : "the volume");
    if (antenna->disagreement) {
        file.text(NetcdfBuilder::file, "position_disagreement", printable(*antenna->disagreement));
    }
}

void write_axes(const CfradialParts& parts) {
    NetcdfBuilder& file = parts.file;
    for (std::size_t i = 0; i < parts.ranges.size(); ++i) {
        const RangeAxis& axis = parts.layout.axes[i];
        const int range = parts.variable(axis.name.c_str(), NC_FLOAT, {parts.ranges[i]},
                                         "range_to_measurement_volume", "meters");
        file.text(range, "standard_name", "projection_range_coordinate");
        file.text(range, "axis", "radial_range_coordinate");
        file.text(range, "spacing_is_constant", "true");
        file.number(range, "meters_to_center_of_first_gate",
                    static_cast<double>(axis.first_gate_m));
        file.number(range, "meters_between_gates", static_cast<double>(axis.gate_spacing_m));
        std::vector<double> centres_m;
        for (std::size_t gate = 0; gate < axis.gates; ++gate)
            centres_m.push_back(axis.first_gate_m + static_cast<double>(axis.gate_spacing_m) *
                                                        static_cast<double>(gate));
        file.write(range, std::span<const double>(centres_m));
    }
}

}  // namespace stormcellar::netcdf
