#include "cli/files/volume_export.h"

#include <fmt/format.h>

#include "level2/decode/problem_notes.h"
#include "level2/decode/volume_checks.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/export/cfradial.h"

namespace stormcellar::cli {

Status export_volume(const std::vector<level2::Volume>& volumes, std::size_t number,
                     const level2::DecodeReport& report, const std::filesystem::path& source,
                     const std::filesystem::path& to) {
    const level2::Volume& volume = volumes[number];
    netcdf::VolumeWriteOptions options;
    options.source_file = source.filename().string();
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

}  // namespace stormcellar::cli
