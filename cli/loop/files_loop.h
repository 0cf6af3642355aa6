// cli/loop/files_loop.h -- catalogs raw files, so that `loop` can draw them like an archive.
//
// The catalog is below --cache, or else beside the private caches (pipeline/care/archive_plan.h).
// The name of its directory has a hash of the directories that hold the files. Files that have not
// changed since they were cataloged are not decoded again, and existing grids are reused. So for a
// growing directory, only new files take time.
//
// Threads   One thread at a time.
#pragma once

#include <filesystem>
#include <set>
#include <vector>

#include "cli/loop/loop_options.h"
#include "cli/shared/interrupt.h"
#include "pipeline/care/archive_fill.h"
#include "stormcellar/base/result.h"
#include "stormcellar/catalog/catalog.h"

namespace stormcellar::cli {

// Catalogs options.files and sets the catalog in `options`. If the options name no stations or no
// times, sets the stations or times of the volumes in the files. Prints to stderr which files are
// left out. An interrupt ends the process at once. Errors: bad_argument for standard input; those
// of InputFiles::find() and of rebuild_catalog(); busy if another loop catalogs the same directory;
// not_found if no file holds a volume.
[[nodiscard]] Status catalog_files(LoopOptions& options, Interrupt& interrupt);

// Returns the files and members of archives that hold no volume or cannot be read, by station.
// catalog_files() has already printed their names.
[[nodiscard]] Result<std::vector<pipeline::LeftOut>> rejected_among(
    const std::set<std::filesystem::path>& files, const catalog::CatalogReader& catalog);

// Removes the catalog if it is private and not to be kept.
[[nodiscard]] Status leave_files(const LoopOptions& options);

}  // namespace stormcellar::cli
