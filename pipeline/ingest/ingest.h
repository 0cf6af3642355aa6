// pipeline/ingest/ingest.h -- registers a raw file in the catalog and puts its grids into the
// cache.
//
// The daemon and the command line share this class. The class never changes the raw file. A file
// that cannot be decoded is recorded as rejected, with the reason; that is a result and not an
// error. If the cache already has a grid of the volume, pipeline/keep/keep_rule.h decides which
// grid stays. A volume that the budgets of the cache would not keep is not gridded. Bad data are no
// error either: an error means that the catalog or the cache cannot be used, or that the system
// refused something, for example memory or descriptors. Trying again later may help. At the last
// try, every failure except a shortage (is_shortage()) is recorded as a rejection with its reason;
// if this rejection cannot be stored, the error is returned. Thread contract: many threads may use
// an Ingestor at the same time, for different files.
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

// Tells ingest() whether the caller will try the file again after a failure.
enum class Tries { more_follow, last };

class Ingestor {
  public:
    Ingestor(catalog::CatalogWriter& catalog, cache::StoreWriter& store, IngestOptions options);
    // Makes an ingestor without a cache, which decodes and registers files but makes no grids.
    Ingestor(catalog::CatalogWriter& catalog, IngestOptions options);
    ~Ingestor();
    Ingestor(const Ingestor&) = delete;
    Ingestor& operator=(const Ingestor&) = delete;

    // Ingests a file. Set `finish_as_is` if the file has not changed for long enough; then a volume
    // that has not ended is gridded, too.
    Result<IngestOutcome> ingest(const std::filesystem::path& path, bool finish_as_is,
                                 Tries tries = Tries::more_follow);
    // If the file exists, is regular and has no row, registers it as seen, without reading it. If
    // the file is gone, marks its rows as gone. Returns `gone` if the file is gone and does not
    // represent a volume in chunks, else `stands`.
    Result<Noted> note(const std::filesystem::path& path);
    // Ingests a file even if it was settled before: grids its volumes again, complete or not. If
    // `is_the_same` fails for the bytes that were read, returns its error and changes nothing.
    // Errors: also not_found if the file is gone.
    Result<IngestOutcome> ingest_again(const std::filesystem::path& path,
                                       const ReadCheck& is_the_same = {});

    // Records a file as rejected, without reading it, with the reason "given up: WHY". The row does
    // not settle the file, so it is tried again when it is next offered. Errors: `why`, if the row
    // cannot be stored.
    Result<IngestOutcome> give_up(const std::filesystem::path& path, const Error& why);

    [[nodiscard]] MosaicMaker& mosaics();

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace stormcellar::pipeline
