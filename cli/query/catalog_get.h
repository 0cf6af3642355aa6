// cli/query/catalog_get.h -- `stormcellar catalog get`: copies or decodes the entries that matched.
#pragma once

#include <string>
#include <vector>

#include "cli/files/volume_export.h"
#include "stormcellar/catalog/catalog.h"

namespace stormcellar::cli {

struct GetOptions {
    std::string output;   // a directory, made if it is missing; "-": standard output
    bool force = false;   // replaces existing files
    bool decode = false;  // writes volumes instead of copying files
    VolumeExportOptions exported;
};

// Copies each file once under its own name, or writes each volume as NAME.nc (NAME_volumeN.nc if
// the file has several), or with the ending of another format. NAME has no ending of a compression.
// Prints the path of each output. Goes on after a failure, and returns the exit status of the last
// failure. If a file was replaced since it was cataloged, does not copy it and counts that as a
// failure.
[[nodiscard]] int get_files(const catalog::CatalogReader& catalog,
                            const std::vector<catalog::CatalogEntry>& entries,
                            const GetOptions& options);

}  // namespace stormcellar::cli
