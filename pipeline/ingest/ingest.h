// pipeline/ingest/ingest.h -- takes one raw file into the catalog and its grids into the cache.
//
// The daemon and the CLI share it. It never changes the raw file. A file that cannot be decoded is
// recorded as rejected, with the reason; that is a result, not an error. The grid of a complete
// volume replaces a grid in the cache; the grid of an incomplete volume never replaces that of a
// complete one. If two existing files have one volume, the file with the later end counts. A volume
// that the limits of the cache would not keep is not gridded. The data never cause an error. An
// error means that the catalog or the cache cannot be written, or that the system has no memory or
// descriptors left; trying again later may help. At the last try, every failure except a shortage
// of the system (is_shortage()) is recorded as a rejection with its reason; if even that cannot be
// stored, the error is returned. Thread contract: many threads may use an Ingestor at once, for
// different files.
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

// Tells ingest() if the caller will try the file again after a failure.
enum class Tries { more_follow, last };

class Ingestor {
  public:
    Ingestor(catalog::CatalogWriter& catalog, cache::StoreWriter& store, IngestOptions options);
    // Makes an ingestor without a cache: files are decoded and registered, but not gridded.
    Ingestor(catalog::CatalogWriter& catalog, IngestOptions options);
    ~Ingestor();
    Ingestor(const Ingestor&) = delete;
    Ingestor& operator=(const Ingestor&) = delete;

    // Ingests a file. `finish_as_is` grids a volume that has not ended (the file was quiet for long
    // enough).
    Result<IngestOutcome> ingest(const std::filesystem::path& path, bool finish_as_is,
                                 Tries tries = Tries::more_follow);
    // Writes a file into the catalog as seen, without reading it, unless it has a row (then the
    // result is `stands`). If the file is gone, marks its rows as gone. The result is then `gone`,
    // or `stands` if the file represents a volume of chunks.
    Result<Noted> note(const std::filesystem::path& path);
    // Does the same as ingest() for a file that was settled before: its volumes are gridded again
    // as they are. If `is_the_same` fails for the bytes read, nothing is done and its error is
    // returned.
    Result<IngestOutcome> ingest_again(const std::filesystem::path& path,
                                       const ReadCheck& is_the_same = {});

    // Rejects a file unread, "given up: WHY". After a restart it is offered again.
    Result<IngestOutcome> give_up(const std::filesystem::path& path, const Error& why);

    [[nodiscard]] MosaicMaker& mosaics();

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace stormcellar::pipeline
