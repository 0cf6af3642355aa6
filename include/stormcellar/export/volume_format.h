// stormcellar/export/volume_format.h -- the formats that a volume can be written in.
//
// Each format has one row in a registry. A writer of volumes chooses the format by its name, or by
// the name of the file; help and messages list the registry.
//
// Threads   Any thread. Each format says whether its calls wait for each other.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "stormcellar/base/file_system.h"
#include "stormcellar/base/result.h"
#include "stormcellar/export/cfradial.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::volume_export {

struct VolumeFormat {
    std::string_view option;                    // as options name it: "odim"
    std::string_view name;                      // "ODIM_H5"
    std::span<const std::string_view> endings;  // of file names; the first is the usual one
    // Writes a volume into one file, whole or not at all. Errors: bad_argument for a sweep without
    // radials, or arrays that do not fit each other; unsupported for what the format cannot hold;
    // internal if a library refuses; those of the file system.
    Status (*write)(FileSystem& file_system, const std::filesystem::path& path,
                    const level2::Volume& volume, const netcdf::VolumeWriteOptions& options);
};

// Returns all formats. The first one is the default if nothing chooses one.
[[nodiscard]] std::span<const VolumeFormat> volume_formats();

// Find a format by its option, or by the ending of a file's name. Of formats with the same ending,
// volume_format_of() returns the first. Both return null if there is no such format.
[[nodiscard]] const VolumeFormat* volume_format_named(std::string_view option);
[[nodiscard]] const VolumeFormat* volume_format_of(std::string_view file_name);

// volume_endings() returns the endings of all formats, each once. known_volume_formats() returns
// the formats for messages: "cfradial (CfRadial, .nc, .nc4) or uf (UF, .uf)".
[[nodiscard]] std::vector<std::string_view> volume_endings();
[[nodiscard]] std::string known_volume_formats();

}  // namespace stormcellar::volume_export
