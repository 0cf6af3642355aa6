// cli/files/volume_export.h -- writes one volume of a decoded file as CfRadial netCDF.
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include <CLI/CLI.hpp>

#include "stormcellar/base/result.h"
#include "stormcellar/level2/decode.h"

namespace stormcellar::cli {

// Writes volumes[number] of the file `source`. Problems that the decoder found become notes in the
// result. Replaces an existing file. With own_ranges, each gate geometry gets its own range axis.
// Errors: those of netcdf::write_volume().
[[nodiscard]] Status export_volume(const std::vector<level2::Volume>& volumes, std::size_t number,
                                   const level2::DecodeReport& report,
                                   const std::filesystem::path& source,
                                   const std::filesystem::path& to, bool own_ranges);

// Adds the flag --own-ranges, for every command that writes volumes.
CLI::Option* add_own_ranges(CLI::App& app, bool& own_ranges);

}  // namespace stormcellar::cli
