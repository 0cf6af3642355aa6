#include "cli/files/volume_export.h"

#include <fmt/format.h>

#include "level2/decode/problem_notes.h"
#include "level2/decode/volume_checks.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/export/cfradial.h"

namespace stormcellar::cli {

Status export_volume(const std::vector<level2::Volume>& volumes, std::size_t number,
                     const level2::DecodeReport& report, const std::filesystem::path& source,
                     const std::filesystem::path& to, bool own_ranges) {
    const level2::Volume& volume = volumes[number];
    netcdf::VolumeWriteOptions options;
    options.source_file = source.filename().string();
    if (own_ranges) options.ranges = netcdf::RangeAxes::of_each_geometry;
    options.notes = level2::notes_of(report);
    options.complete = report.complete;
    if (volumes.size() > 1) {
        options.complete = !report.damaged && level2::is_complete(volume);
        options.notes.insert(options.notes.begin(),
                             fmt::format("the file holds {} volumes; this is number {}",
                                         volumes.size(), number + 1));
    }
    return netcdf::write_volume(real_file_system(), to, volume, options);
}

CLI::Option* add_own_ranges(CLI::App& app, bool& own_ranges) {
    return app.add_flag(
        "--own-ranges", own_ranges,
        "In netCDF, write every gate once, with a range axis for each gate length. Default: one "
        "axis if the lengths allow it, on which longer gates are repeated");
}

}  // namespace stormcellar::cli
