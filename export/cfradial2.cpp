#include "export/cfradial2.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <netcdf.h>

#include "export/cfradial_parts.h"
#include "export/exchange_names.h"
#include "export/volume_facts.h"

namespace stormcellar::netcdf {
namespace {

using level2::Sweep;
using level2::Volume;

constexpr CfradialVersion version_2{
    "CF-1.8, WMO CF-1.0, ACDD-1.3, Cf/Radial-2.1", "2.1", "WMO FM 301-2022; CfRadial 2.1, NCAR/EOL",
    "Codes are those of the radar, none is resampled: moments of a sweep that differ in range, "
    "scale or offset are variables of their own, as the attribute moment says, or gates longer "
    "than those of range are repeated, as the variables gate_repeats say. Whatever is no value is "
    "_FillValue; the status variable of each moment says why."};

FieldNames names_in_fm301(level2::Moment moment) {
    const ExchangeNames names = exchange_names_of(moment);
    return {names.name, names.standard_name};
}

std::string group_name(std::size_t sweep) {
    return fmt::format("sweep_{}", sweep);
}

void write_string(NetcdfBuilder& file, const char* name, const char* long_name,
                  const std::string& value) {
    const int made = described_variable(file, name, NC_STRING, {}, long_name, nullptr);
    file.write(made, std::span<const std::string>(&value, 1));
}

// Returns how the pulses of the sweep follow each other, by the waveform of its cut.
std::string prt_mode_of(const Volume& volume, const Sweep& sweep) {
    const auto cut = static_cast<std::size_t>(sweep.elevation_number) - 1;
    if (!volume.vcp_message || cut >= volume.vcp_message->cuts.size()) return "not_set";
    switch (volume.vcp_message->cuts[cut].waveform) {
        case 1:
        case 2:
        case 3:
            return "fixed";
        case 4:
            return "dual";
        case 5:
            return "staggered";
        default:
            return "not_set";
    }
}

void write_root(NetcdfBuilder& file, const Volume& volume, const VolumeWriteOptions& options,
                const Coverage& coverage) {
    constexpr int global = NetcdfBuilder::file;
    write_titles(file, volume, options, coverage.start, version_2);
    file.text(global, "wmo__cf_profile", "FM 301-2022");
    if (volume.vcp) {
        file.text(global, "scan_name", fmt::format("VCP-{}", *volume.vcp));
        file.number(global, "scan_id", *volume.vcp);
    }
    file.text(global, "platform_is_mobile", "false");
    file.text(global, "ray_times_increase", coverage.times_increase ? "true" : "false");
    if (!options.notes.empty()) file.text(global, "notes", text_of_notes(options.notes));
    write_power_attributes(file, volume);
    write_volume_number(file, volume);
    write_string(file, "platform_type", "platform_type", "fixed");
    write_string(file, "instrument_type", "type_of_instrument", "radar");
    write_string(file, "primary_axis", "primary_axis_of_rotation", "axis_z");
    write_string(file, "time_coverage_start", "data_volume_start_time_utc",
                 format_utc(coverage.start));
    write_string(file, "time_coverage_end", "data_volume_end_time_utc", format_utc(coverage.end));
    write_position(file, volume);

    const int sweep = file.dimension("sweep", volume.sweeps.size());
    std::vector<std::string> names;
    std::vector<float> angles_deg;
    for (const Sweep& each : volume.sweeps) {
        names.push_back(group_name(names.size()));
        angles_deg.push_back(fixed_angle_deg(each));
    }
    const int groups = described_variable(file, "sweep_group_name", NC_STRING, {sweep},
                                          "group_name_for_sweep", nullptr);
    file.write(groups, std::span<const std::string>(names));
    const int fixed = described_variable(file, "sweep_fixed_angle", NC_FLOAT, {sweep},
                                         "target_fixed_angle", "degrees");
    file.write(fixed, std::span<const float>(angles_deg));
}

void write_sweep_facts(const CfradialParts& parts, const Volume& volume, std::size_t number) {
    const Sweep& sweep = parts.sweeps.front();
    NetcdfBuilder& file = parts.file;
    write_ints(parts, "sweep_number", {}, "sweep_index_number_0_based", {static_cast<int>(number)});
    write_string(file, "sweep_mode", "scan_mode_for_sweep", "azimuth_surveillance");
    write_string(file, "follow_mode", "follow_mode_for_sweep", "none");
    write_string(file, "prt_mode", "prt_mode_for_sweep", prt_mode_of(volume, sweep));
    const int fixed =
        parts.variable("sweep_fixed_angle", NC_FLOAT, {}, "target_fixed_angle", "degrees");
    file.write(fixed, std::span<const float>(std::array{fixed_angle_deg(sweep)}));
    write_string(file, "rays_are_indexed", "flag_for_indexed_rays",
                 sweep.radials.front().azimuth_indexing != 0 ? "true" : "false");
    write_known(parts, "ray_angle_res", {}, "angular_resolution_between_rays", "degrees",
                {unless_zero(sweep.azimuth_spacing_deg)});
    write_ints(parts, "elevation_number", {}, "cut of the VCP, from 1", {sweep.elevation_number});
    write_ints(parts, "message_type", {}, "Level II message of the radials, 1 or 31",
               {sweep.message_type});
}

void write_sweep(NetcdfBuilder& file, const Volume& volume, std::size_t number,
                 const CfradialLayout& layout, UtcTime reference, int deflate_level) {
    file.group(group_name(number).c_str());
    CfradialParts parts{
        file,          std::span(volume.sweeps).subspan(number, 1), layout, reference,
        deflate_level, file.dimension("time", layout.radials),      {},     {}};
    for (const RangeAxis& axis : layout.axes)
        parts.ranges.push_back(file.dimension(axis.name.c_str(), axis.gates));
    write_sweep_facts(parts, volume, number);
    write_axes(parts);
    write_radial_variables(parts);
    write_fields(parts);
}

Result<std::vector<std::byte>> build(const Volume& volume,
                                     const std::vector<CfradialLayout>& layouts,
                                     const VolumeWriteOptions& options) {
    const MutexLock lock(library_mutex());
    const Coverage coverage = coverage_of(volume);
    NetcdfBuilder file;
    write_root(file, volume, options, coverage);
    for (std::size_t sweep = 0; sweep < layouts.size(); ++sweep)
        write_sweep(file, volume, sweep, layouts[sweep], coverage.start, options.deflate_level);
    return file.finish();
}

}  // namespace

Status write_cfradial2(FileSystem& file_system, const std::filesystem::path& path,
                       const Volume& volume, const VolumeWriteOptions& options) {
    if (Status good = check_deflate_level(options); !good) return good;
    if (Status good = check_sweeps(volume.sweeps); !good)
        return fail(good.error().code, "{}: {}", path.string(), good.error().message);
    std::vector<CfradialLayout> layouts;
    for (std::size_t sweep = 0; sweep < volume.sweeps.size(); ++sweep) {
        auto layout =
            lay_out(std::span(volume.sweeps).subspan(sweep, 1), options.ranges, names_in_fm301);
        if (!layout)
            return fail(layout.error().code, "{}: {}", path.string(), layout.error().message);
        layouts.push_back(std::move(*layout));
    }
    const auto bytes = build(volume, layouts, options);
    if (!bytes) return fail(bytes.error().code, "{}: {}", path.string(), bytes.error().message);
    return write_file_atomically(file_system, path, *bytes);
}

}  // namespace stormcellar::netcdf
