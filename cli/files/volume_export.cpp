#include "cli/files/volume_export.h"

#include <fmt/format.h>

#include "level2/decode/problem_notes.h"
#include "level2/decode/volume_checks.h"
#include "stormcellar/base/file_system.h"

namespace stormcellar::cli {

Status export_volume(const std::vector<level2::Volume>& volumes, std::size_t number,
                     const level2::DecodeReport& report, const std::filesystem::path& source,
                     const std::filesystem::path& to, const volume_export::VolumeFormat& format,
                     const VolumeExportOptions& options) {
    const level2::Volume& volume = volumes[number];
    netcdf::VolumeWriteOptions writing;
    writing.source_file = source.filename().string();
    if (options.own_ranges) writing.ranges = netcdf::RangeAxes::of_each_geometry;
    writing.notes = level2::notes_of(report);
    writing.complete = report.complete;
    if (volumes.size() > 1) {
        writing.complete = !report.damaged && level2::is_complete(volume);
        writing.notes.insert(writing.notes.begin(),
                             fmt::format("the file holds {} volumes; this is number {}",
                                         volumes.size(), number + 1));
    }
    return format.write(real_file_system(), to, volume, writing);
}

void add_volume_export_options(CLI::App& app, VolumeExportOptions& options, CLI::Option* needed) {
    std::vector<std::string> names;
    for (const volume_export::VolumeFormat& format : volume_export::volume_formats())
        names.emplace_back(format.option);
    app.add_option("--format", options.format,
                   fmt::format("Format of volumes: {}. Default: by the ending of the file, or "
                               "cfradial",
                               volume_export::known_volume_formats()))
        ->check(CLI::IsMember(names))
        ->needs(needed);
    app.add_flag("--own-ranges", options.own_ranges,
                 "In netCDF and UF, write every gate once, with a range axis for each gate "
                 "length. Default: one axis if the lengths allow it, on which longer gates are "
                 "repeated")
        ->needs(needed);
}

const volume_export::VolumeFormat& format_for(const VolumeExportOptions& options,
                                              std::string_view file_name) {
    const auto* format = options.format.empty()
                             ? volume_export::volume_format_of(file_name)
                             : volume_export::volume_format_named(options.format);
    return format == nullptr ? volume_export::volume_formats().front() : *format;
}

}  // namespace stormcellar::cli
