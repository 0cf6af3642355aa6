// cli/serve/scratch_cellar.h -- makes a catalog and a cache in a temporary directory from the files
// of a command line, as stormcellard would make them.
//
// The raw files are read in place. The destructor removes the directory.
//
// Threads   One thread at a time; others may read catalog and cache meanwhile.
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

// Returns the absolute paths, without links, of the named files and of all files in named
// directories and sets of chunks, sorted. Prints a note on stderr for each entry that
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
    // made; a note on stderr says why a file gives none. Errors: those of
    // pipeline::Ingestor::ingest().
    Result<std::size_t> take(const std::filesystem::path& file);
    // Grids the derived moments of a file that take() ingested before. Dealiasing takes time, which
    // the first picture need not wait for. Errors: those of pipeline::Ingestor::ingest_again().
    Status derive(const std::filesystem::path& file);

  private:
    ScratchCellar(ScratchDirectory scratch, catalog::CatalogWriter catalog,
                  cache::StoreWriter store, int threads);

    ScratchDirectory scratch_;
    catalog::CatalogWriter catalog_;
    cache::StoreWriter store_;
    pipeline::Ingestor ingestor_;
    pipeline::Ingestor deriver_;  // makes the grids of derived moments alone
};

}  // namespace stormcellar::cli
