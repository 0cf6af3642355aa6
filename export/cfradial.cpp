#include "stormcellar/export/cfradial.h"

#include <fmt/ranges.h>
#include <netcdf.h>

#include "export/cfradial_parts.h"
#include "export/volume_facts.h"

namespace stormcellar::netcdf {
namespace {

using level2::Sweep;
using level2::Volume;

constexpr CfradialVersion version_1_4{
    "CF-1.7 CF/Radial instrument_parameters", "1.4", "CfRadial 1.4, NCAR/EOL",
    "Codes are those of the radar, none is resampled: moments that differ in range, scale "
    "or offset are variables of their own, as the attribute moment says, or gates longer "
    "than those of range are repeated, as the variables gate_repeats say. Whatever is no "
    "value is _FillValue; the status variable of each moment says why."};

// Writes one word for each element of the dimension, or a single word if there is no dimension.
void write_words(const CfradialParts& parts, int letter, const char* name,
                 std::vector<int> dimensions, const char* long_name,
                 const std::vector<std::string>& values) {
    dimensions.push_back(letter);
    const int made = described_variable(parts.file, name, NC_CHAR, dimensions, long_name, nullptr);
    std::string letters;
    for (const std::string& value : values) {
        std::string word = value;
        word.resize(string_length);
        letters += word;
    }
    parts.file.write(made, std::span<const char>(letters));
}

void write_attributes(const CfradialParts& parts, const Volume& volume,
                      const VolumeWriteOptions& options, bool times_increase) {
    constexpr int global = NetcdfBuilder::file;
    NetcdfBuilder& file = parts.file;
    write_titles(file, volume, options, parts.reference, version_1_4);
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
    if (!options.notes.empty()) file.text(global, "notes", text_of_notes(options.notes));
    write_power_attributes(file, volume);
}

void write_scalars(const CfradialParts& parts, const Volume& volume, const Coverage& coverage,
                   int letter) {
    write_volume_number(parts.file, volume);
    const auto word = [&](const char* name, const char* long_name, const std::string& value) {
        write_words(parts, letter, name, {}, long_name, {value});
    };
    word("platform_type", "platform_type", "fixed");
    word("instrument_type", "type_of_instrument", "radar");
    word("primary_axis", "primary_axis_of_rotation", "axis_z");
    word("time_coverage_start", "data_volume_start_time_utc", format_utc(coverage.start));
    word("time_coverage_end", "data_volume_end_time_utc", format_utc(coverage.end));
}

template <class Value, class Function>
std::vector<Value> of_each_sweep(const CfradialParts& parts, Function function) {
    std::vector<Value> values;
    values.reserve(parts.sweeps.size());
    for (const Sweep& sweep : parts.sweeps)
        values.push_back(function(sweep));
    return values;
}

void write_sweep_places(const CfradialParts& parts, int letter) {
    const std::size_t count = parts.sweeps.size();
    std::vector<int> numbers;
    std::vector<int> starts;
    std::vector<int> ends;
    for (std::size_t sweep = 0; sweep < count; ++sweep) {
        const std::size_t start = parts.layout.first_radials[sweep];
        numbers.push_back(static_cast<int>(sweep));
        starts.push_back(static_cast<int>(start));
        ends.push_back(static_cast<int>(start + parts.sweeps[sweep].radials.size() - 1));
    }
    write_ints(parts, "sweep_number", parts.sweep, "sweep_index_number_0_based", numbers);
    write_ints(parts, "sweep_start_ray_index", parts.sweep, "index_of_first_ray_in_sweep", starts);
    write_ints(parts, "sweep_end_ray_index", parts.sweep, "index_of_last_ray_in_sweep", ends);
    write_words(parts, letter, "sweep_mode", parts.sweep, "scan_mode_for_sweep",
                std::vector<std::string>(count, "azimuth_surveillance"));
}

void write_sweep_variables(const CfradialParts& parts, int letter) {
    write_sweep_places(parts, letter);
    const int fixed =
        parts.variable("fixed_angle", NC_FLOAT, parts.sweep, "target_fixed_angle", "degrees");
    parts.file.text(fixed, "comment",
                    "as the VCP has it; where it is not known, the median of the elevations");
    const auto angles_deg = of_each_sweep<float>(parts, fixed_angle_deg);
    parts.file.write(fixed, std::span<const float>(angles_deg));
    write_ints(parts, "elevation_number", parts.sweep, "cut of the VCP, from 1",
               of_each_sweep<int>(parts, [](const Sweep& s) { return s.elevation_number; }));
    write_ints(parts, "message_type", parts.sweep, "Level II message of the radials, 1 or 31",
               of_each_sweep<int>(parts, [](const Sweep& s) { return s.message_type; }));
    write_words(parts, letter, "rays_are_indexed", parts.sweep, "flag_for_indexed_rays",
                of_each_sweep<std::string>(parts, [](const Sweep& s) {
                    return s.radials.front().azimuth_indexing != 0 ? "true" : "false";
                }));
    write_known(parts, "ray_angle_res", parts.sweep, "angular_resolution_between_rays", "degrees",
                of_each_sweep<Known>(
                    parts, [](const Sweep& s) { return unless_zero(s.azimuth_spacing_deg); }));
}

Result<std::vector<std::byte>> build(const Volume& volume, const CfradialLayout& layout,
                                     const VolumeWriteOptions& options) {
    const MutexLock lock(library_mutex());
    const Coverage coverage = coverage_of(volume);
    NetcdfBuilder file;
    CfradialParts parts{file,
                        volume.sweeps,
                        layout,
                        coverage.start,
                        options.deflate_level,
                        file.dimension("time", layout.radials),
                        {file.dimension("sweep", volume.sweeps.size())},
                        {}};
    const int letter = file.dimension("string_length", string_length);
    for (const RangeAxis& axis : layout.axes)
        parts.ranges.push_back(file.dimension(axis.name.c_str(), axis.gates));
    write_attributes(parts, volume, options, coverage.times_increase);
    write_scalars(parts, volume, coverage, letter);
    write_position(file, volume);
    write_axes(parts);
    write_sweep_variables(parts, letter);
    write_radial_variables(parts);
    write_fields(parts);
    return file.finish();
}

}  // namespace

Status check_deflate_level(const VolumeWriteOptions& options) {
    if (options.deflate_level >= 0 && options.deflate_level <= 9) return {};
    return fail(ErrorCode::bad_argument, "the deflate level must be 0 to 9, not {}",
                options.deflate_level);
}

Status write_volume(FileSystem& file_system, const std::filesystem::path& path,
                    const Volume& volume, const VolumeWriteOptions& options) {
    if (Status good = check_deflate_level(options); !good) return good;
    const auto layout = lay_out(volume.sweeps, options.ranges);
    if (!layout) return fail(layout.error().code, "{}: {}", path.string(), layout.error().message);
    const auto bytes = build(volume, *layout, options);
    if (!bytes) return fail(bytes.error().code, "{}: {}", path.string(), bytes.error().message);
    return write_file_atomically(file_system, path, *bytes);
}

}  // namespace stormcellar::netcdf
