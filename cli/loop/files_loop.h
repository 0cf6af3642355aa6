// cli/loop/files_loop.h -- a loop of raw files that a command line names: it is a loop of an
// archive whose catalog is made first, of these files.
//
// The catalog lies beside the grids: below --cache, else where the private caches are
// (pipeline/care/archive_plan.h). Its name has a hash of the directories that the files are in.
// Files that it has in their present state are not decoded again, and grids that stand are taken,
// so that a directory that grows costs what is new in it.
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

// Catalogs options.files, and says in `options` that the loop is of this catalog: of the stations
// that the files hold and the times that their volumes span, as far as options do not say them.
// Names on stderr what is left out. An interrupt ends the process at once. Errors: bad_argument for
// standard input; those of InputFiles::find() and of rebuild_catalog(); busy if another loop
// catalogs the same directory; not_found if no file holds a volume.
[[nodiscard]] Status catalog_files(LoopOptions& options, Interrupt& interrupt);

// Returns those of the files, and of the members of these archives, that hold no volume or cannot
// be read, by station. catalog_files() has named them.
[[nodiscard]] Result<std::vector<pipeline::LeftOut>> rejected_among(
    const std::set<std::filesystem::path>& files, const catalog::CatalogReader& catalog);

// Removes the catalog, where it is private and not to be kept.
[[nodiscard]] Status leave_files(const LoopOptions& options);

}  // namespace stormcellar::cli
