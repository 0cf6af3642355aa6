// pipeline/ingest/ingest.h -- one raw file -> catalog -> grid in the cache.
//
// Shared by the daemon and the CLI. Never changes the raw file. A file that cannot be decoded is
// recorded as rejected with its reason; that is a result, not an error.
// A grid in the cache is replaced by one of a whole volume or of a newer file, never by one of a
// part of it or of an older file. A volume that the cache's budgets would not keep is not gridded.
// Errors are never of the data: the catalog or the cache cannot be written, the system gives no
// memory or descriptors. Trying again later may help. With the last try whatever is no shortage of
// the system (is_shortage()) is recorded as a rejection with its reason; where not even that can be
// stored, the error comes out all the same.
// Thread contract: an Ingestor may be used by many threads at once, for different files.
#pragma once

#include <filesystem>
#include <memory>

#include "pipeline/options/ingest_options.h"
#include "pipeline/options/ingest_outcome.h"
#include "stormcellar/base/result.h"
#include "stormcellar/cache/store.h"
#include "stormcellar/catalog/catalog.h"

namespace stormcellar::pipeline {

class MosaicMaker;

// Whether a file that cannot be ingested is tried again after this.
enum class Tries { more_follow, last };

class Ingestor {
  public:
    Ingestor(catalog::CatalogWriter& catalog, cache::StoreWriter& store, IngestOptions options);
    // Without a cache: files are decoded and registered, but not gridded.
    Ingestor(catalog::CatalogWriter& catalog, IngestOptions options);
    ~Ingestor();
    Ingestor(const Ingestor&) = delete;
    Ingestor& operator=(const Ingestor&) = delete;

    // finish_as_is: grids a volume that has not ended (the file was quiet for long enough).
    Result<IngestOutcome> ingest(const std::filesystem::path& path, bool finish_as_is,
                                 Tries tries = Tries::more_follow);
    // Writes a file into the catalog as seen, unread, unless it stands there (stands), or marks
    // its rows when it is gone (gone; stands where a volume of chunks waits in its name).
    Result<Noted> note(const std::filesystem::path& path);
    // Does the same as ingest() for a file that was settled before: its volumes are gridded again
    // as they are. If `is_the_same` fails for the bytes read, nothing is done and its error is
    // returned.
    Result<IngestOutcome> ingest_again(const std::filesystem::path& path,
                                       const ReadCheck& is_the_same = {});

    [[nodiscard]] MosaicMaker& mosaics();

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace stormcellar::pipeline
