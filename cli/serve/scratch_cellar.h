// cli/serve/scratch_cellar.h -- a catalog and a cache in a temporary directory, made of the files
// that a command line names, as stormcellard would make them.
//
// The raw files are read where they are. The directory is removed with the object.
//
// Threads   One thread at a time; catalog and cache may be read by others meanwhile.
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

// Returns the files of these names, of directories and chunks all in them, sorted: absolute paths
// without links. What is no volume is named on stderr and left out. Errors: those of
// InputFiles::find(); bad_argument for standard input.
[[nodiscard]] Result<std::vector<std::filesystem::path>> files_to_serve(
    const std::vector<std::string>& names);

class ScratchCellar {
  public:
    // Grids the volumes with all of their moments. Errors: io if the directory cannot be made.
    static Result<std::unique_ptr<ScratchCellar>> make(int threads);

    [[nodiscard]] std::filesystem::path catalog() const { return scratch_.path() / "catalog"; }
    [[nodiscard]] std::filesystem::path cache() const { return scratch_.path() / "cache"; }
    // Takes in one file. Returns the number of its grids; 0 with a note on stderr if nothing can be
    // made of it. Errors: those of a full disk.
    Result<std::size_t> take(const std::filesystem::path& file);

  private:
    ScratchCellar(ScratchDirectory scratch, catalog::CatalogWriter catalog,
                  cache::StoreWriter store, int threads);

    ScratchDirectory scratch_;
    catalog::CatalogWriter catalog_;
    cache::StoreWriter store_;
    pipeline::Ingestor ingestor_;
};

}  // namespace stormcellar::cli
