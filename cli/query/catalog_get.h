// cli/query/catalog_get.h -- what `stormcellar catalog get` does with the entries that matched.
#pragma once

#include <string>
#include <vector>

#include "stormcellar/catalog/catalog.h"

namespace stormcellar::cli {

struct GetOptions {
    std::string output;   // a directory, made when it is not there; "-": standard output
    bool force = false;   // replace files that are there
    bool decode = false;  // write volumes as CfRadial instead of copying files
};

// Copies each file once under its own name; or writes each volume as NAME.nc, NAME without what
// says that it is compressed, and as NAME_volumeN.nc when the file holds several. Prints the path
// of each. Goes on after a failure; gives the exit status of the last one.
// A file that is no longer the one that was cataloged is not copied and is a failure.
[[nodiscard]] int get_files(const catalog::CatalogReader& catalog,
                            const std::vector<catalog::CatalogEntry>& entries,
                            const GetOptions& options);

}  // namespace stormcellar::cli
