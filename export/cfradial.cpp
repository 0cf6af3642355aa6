#include "stormcellar/export/cfradial.h"

#include <algorithm>
#include <array>
#include <chrono>

#include <fmt/ranges.h>
#include <netcdf.h>

#include "base/printable.h"
#include "export/cfradial_parts.h"
#include "stormcellar/base/station_table.h"
#include "stormcellar/base/version.h"

namespace stormcellar::netcdf {

int CfradialParts::variable(const char* name, int type, const std::vector<int>& dimensions,
                            const char* long_name, const char* units) const {
    const int made = file.variable(name, type, dimensions);
    file.text(made, "long_name", long_name);
    file.text(made, "units", units);
    return made;
}

int CfradialParts::words(const char* name, const std::vector<int>& dimensions,
                         const char* long_name, const std::vector<std::string>& values) const {
    const int made = file.variable(name, NC_CHAR, dimensions);
    file.text(made, "long_name", long_name);
    std::string letters;
    for (const std::string& value : values) {
        std::string word = value;
        word.resize(string_length);
        letters += word;
    }
    file.write(made, std::span<const char>(letters));
    return made;
}

namespace {

using level2::Volume;

// The times of the first and the last radial. If no radial has a plausible time, both are the start
// of the volume.
struct Coverage {
    UtcTime start, end;  // whole seconds, between which the volume is
    bool times_increase = true;
};

Coverage coverage_of(const Volume& volume) {
    std::optional<UtcTime> first;
    std::optional<UtcTime> last;
    std::optional<UtcTime> before;
    Coverage coverage;
    for (const level2::Sweep& sweep : volume.sweeps) {
        for (const level2::Radial& radial : sweep.radials) {
            if (before && radial.time < *before) coverage.times_increase = false;
            before = radial.time;
            if (!level2::is_plausible(radial.time)) continue;
            first = std::min(first.value_or(radial.time), radial.time);
            last = std::max(last.value_or(radial.time), radial.time);
        }
    }
    const UtcTime start = first.value_or(volume.start_time().value_or(UtcTime{}));
    coverage.start = std::chrono::floor<std::chrono::seconds>(start);
    coverage.end = std::chrono::ceil<std::chrono::seconds>(last.value_or(start));
    return coverage;
}

// Returns the operator of the radar. Level II does not name it, but the radar's site tells it.
std::string institution_of(const std::optional<Station>& station) {
    if (!station) return "unknown";
    return station->kind == RadarKind::tdwr ? "TDWR network of the FAA"
                                            : "NEXRAD network of NOAA, the U.S. Air Force and FAA";
}

void write_titles(const CfradialParts& parts, const VolumeWriteOptions& options) {
    constexpr int global = NetcdfBuilder::file;
    NetcdfBuilder& file = parts.file;
    const Volume& volume = parts.volume;
    const auto station = find_station(volume.station);
    const std::string name = volume.station.empty() ? "unknown" : printable(volume.station);
    const std::string source = printable(options.source_file);
    const std::string software = fmt::format("stormcellar {}", software_version);
    file.text(global, "Conventions", "CF-1.7 CF/Radial instrument_parameters");
    file.text(global, "version", "1.4");
    file.text(global, "title",
              fmt::format("Radar volume of {}, {}", name, format_utc(parts.reference)));
    file.text(global, "institution", institution_of(station));
    file.text(global, "references",
              "NEXRAD ICD 2620002 (RDA/RPG) and 2620010 (Archive II/User); CfRadial 1.4, NCAR/EOL");
    file.text(global, "source", "weather radar Level II volume");
    file.text(global, "history",
              source.empty() ? software + ": decoded"
                             : fmt::format("{}: decoded from {}", software, source));
    file.text(
        global, "comment",
        "Codes are those of the radar, none is resampled: moments that differ in range, scale "
        "or offset are variables of their own, as the attribute moment says, or gates longer "
        "than those of range are repeated, as the variables gate_repeats say. Whatever is no "
        "value is _FillValue; the status variable of each moment says why.");
    file.text(global, "instrument_name", name);
    file.text(global, "site_name",
              station ? fmt::format("{}, {}", station->name, station->state) : "unknown");
    if (!source.empty()) file.text(global, "source_file", source);
    file.text(global, "software_version", software);
    file.text(global, "volume", options.complete ? "complete" : "partial");
}

void write_attributes(const CfradialParts& parts, const VolumeWriteOptions& options,
                      bool times_increase) {
    constexpr int global = NetcdfBuilder::file;
    NetcdfBuilder& file = parts.file;
    const Volume& volume = parts.volume;
    write_titles(parts, options);
    if (volume.vcp) file.number(global, "scan_id", *volume.vcp);
    file.text(global, "platform_is_mobile", "false");
    file.text(global, "n_gates_vary", "false");
    file.text(global, "ray_times_increase", times_increase ? "true" : "false");
    std::vector<std::string> names;
    for (const CfradialField& field : parts.layout.fields) {
        names.push_back(field.name);
        names.push_back(field.name + "_status");
    }
    file.text(global, "field_names", fmt::format("{}", fmt::join(names, ",")));
    if (!options.notes.empty()) {
        std::vector<std::string> notes;
        for (const std::string& note : options.notes)
            notes.push_back(printable(note));
        file.text(global, "notes", fmt::format("{}", fmt::join(notes, "\n")));
    }
    if (!volume.block) return;
    const level2::VolumeBlock& block = *volume.block;
    file.number(global, "transmitter_power_h_kw", static_cast<double>(block.horizontal_power_kw));
    file.number(global, "transmitter_power_v_kw", static_cast<double>(block.vertical_power_kw));
    file.number(global, "reflectivity_calibration_db", static_cast<double>(block.calibration_db));
    file.number(global, "system_zdr_db", static_cast<double>(block.differential_reflectivity_db));
    file.number(global, "system_phi_deg",
                static_cast<double>(block.initial_differential_phase_deg));
}

void write_scalars(const CfradialParts& parts, const Coverage& coverage) {
    NetcdfBuilder& file = parts.file;
    const Volume& volume = parts.volume;
    const auto number = volume.header ? volume.header->volume_number() : std::nullopt;
    const int volume_number =
        parts.variable("volume_number", NC_INT, {}, "data_volume_index_number", "1");
    constexpr int unknown = -1;
    if (!number) file.fill_value(volume_number, unknown);
    file.write(volume_number, std::array<int, 1>{number.value_or(unknown)});
    const auto word = [&](const char* name, const char* long_name, const std::string& value) {
        return parts.words(name, {parts.letter}, long_name, {value});
    };
    word("platform_type", "platform_type", "fixed");
    word("instrument_type", "type_of_instrument", "radar");
    word("primary_axis", "primary_axis_of_rotation", "axis_z");
    word("time_coverage_start", "data_volume_start_time_utc", format_utc(coverage.start));
    word("time_coverage_end", "data_volume_end_time_utc", format_utc(coverage.end));
}

void write_position(const CfradialParts& parts) {
    NetcdfBuilder& file = parts.file;
    const auto antenna = level2::antenna_position(parts.volume);
    const auto write = [&](const char* name, const char* units, std::optional<double> value) {
        const int variable = parts.variable(name, NC_DOUBLE, {}, name, units);
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

Result<std::vector<std::byte>> build(const Volume& volume, const CfradialLayout& layout,
                                     const VolumeWriteOptions& options) {
    const MutexLock lock(library_mutex());
    const Coverage coverage = coverage_of(volume);
    NetcdfBuilder file;
    CfradialParts parts{file,
                        volume,
                        layout,
                        coverage.start,
                        options.deflate_level,
                        file.dimension("time", layout.radials),
                        file.dimension("sweep", volume.sweeps.size()),
                        file.dimension("string_length", string_length),
                        {}};
    for (const RangeAxis& axis : layout.axes)
        parts.ranges.push_back(file.dimension(axis.name.c_str(), axis.gates));
    write_attributes(parts, options, coverage.times_increase);
    write_scalars(parts, coverage);
    write_position(parts);
    write_axes(parts);
    write_sweep_variables(parts);
    write_radial_variables(parts);
    write_fields(parts);
    return file.finish();
}

}  // namespace

Status write_volume(FileSystem& file_system, const std::filesystem::path& path,
                    const Volume& volume, const VolumeWriteOptions& options) {
    if (options.deflate_level < 0 || options.deflate_level > 9) {
        return fail(ErrorCode::bad_argument, "the deflate level must be 0 to 9, not {}",
                    options.deflate_level);
    }
    const auto layout = lay_out(volume, options.ranges);
    if (!layout) return fail(layout.error().code, "{}: {}", path.string(), layout.error().message);
    const auto bytes = build(volume, *layout, options);
    if (!bytes) return fail(bytes.error().code, "{}: {}", path.string(), bytes.error().message);
    return write_file_atomically(file_system, path, *bytes);
}

}  // namespace stormcellar::netcdf
