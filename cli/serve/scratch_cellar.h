// cli/serve/scratch_cellar.h -- makes a catalog and a cache in a temporary directory from the files
// of a command line. Both are the same as stormcellard would make.
//
// The raw files are read in place. The destructor removes the directory.
//
// Threads   One thread at a time; other threads may read the catalog and the cache meanwhile.
// Errors    See each function.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "cli/shared/scratch_directory.h"
#include "pipeline/ingest/ingest.h"
#include "stormcellar/base/result.h"
#include "stormcellar/cache/store.h"
#include "stormcellar/catalog/catalog.h"

namespace stormcellar::cli {

// Returns the absolute paths, with links resolved, of the named files and of all files in named
// directories and sets of chunks. The paths are sorted. Prints a note on stderr for each entry that
// InputFiles::find() leaves out. Errors: those of InputFiles::find(); bad_argument for standard
// input.
[[nodiscard]] Result<std::vector<std::filesystem::path>> files_to_serve(
    const std::vector<std::string>& names);

class ScratchCellar {
  public:
    // Makes the directory. Errors: io if it cannot be made.
    static Result<std::unique_ptr<ScratchCellar>> make(int threads);

    [[nodiscard]] std::filesystem::path catalog() const { return scratch_.path() / "catalog"; }
    [[nodiscard]] std::filesystem::path cache() const { return scratch_.path() / "cache"; }
    // Ingests one file, and grids all measured moments of its volumes. Returns the number of grids
    // that were made. If a file gives no grids, prints a note on stderr that says why. Errors:
    // those of pipeline::Ingestor::ingest().
    Result<std::size_t> take(const std::filesystem::path& file);
    // Grids the derived moments of a file that take() ingested before. This is separate from take()
    // because dealiasing takes time, for which the first picture need not wait. Errors: those of
    // pipeline::Ingestor::ingest_again().
    Status derive(const std::filesystem::path& file);

  private:
    ScratchCellar(ScratchDirectory scratch, catalog::CatalogWriter catalog,
                  cache::StoreWriter store, int threads);

    ScratchDirectory scratch_;
    catalog::CatalogWriter catalog_;
    cache::StoreWriter store_;
    pipeline::Ingestor ingestor_;
    pipeline::Ingestor deriver_;  // makes only the grids of derived moments
};

}  // namespace stormcellar::cli
