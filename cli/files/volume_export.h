// cli/files/volume_export.h -- writes one volume of a decoded file in a format of volumes.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include "stormcellar/base/result.h"
#include "stormcellar/export/volume_format.h"
#include "stormcellar/level2/decode.h"

namespace stormcellar::cli {

struct VolumeExportOptions {
    std::string format;       // as the registry names it; empty: the file name chooses
    bool own_ranges = false;  // gives each gate geometry its own range axis
};

// Adds --format and --own-ranges, for every command that writes volumes. Both options need the
// option `needed`.
void add_volume_export_options(CLI::App& app, VolumeExportOptions& options, CLI::Option* needed);

// Returns the format that the options name, else that of the file name, else the default.
[[nodiscard]] const volume_export::VolumeFormat& format_for(const VolumeExportOptions& options,
                                                            std::string_view file_name = {});

// Writes volumes[number] of the file `source`. Problems that the decoder found become notes in the
// result. Replaces an existing file. Errors: those of the format.
[[nodiscard]] Status export_volume(const std::vector<level2::Volume>& volumes, std::size_t number,
                                   const level2::DecodeReport& report,
                                   const std::filesystem::path& source,
                                   const std::filesystem::path& to,
                                   const volume_export::VolumeFormat& format,
                                   const VolumeExportOptions& options);

}  // namespace stormcellar::cli
