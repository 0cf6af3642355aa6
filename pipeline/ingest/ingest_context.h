// pipeline/ingest/ingest_context.h -- state and functions that the handlers of all kinds of files
// share: the catalog, the store, the growing files, and writing catalog rows.
//
// Inside the pipeline room only. Thread contract: as for Ingestor, many threads may call all
// functions, for different files.
#pragma once

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <optional>
#include <string>

#include "pipeline/drop/file_facts.h"
#include "pipeline/ingest/chunk_volumes.h"
#include "pipeline/ingest/followed_files.h"
#include "pipeline/ingest/open_archives.h"
#include "pipeline/keep/site_grids.h"
#include "pipeline/mosaic/mosaic_maker.h"
#include "pipeline/options/ingest_options.h"
#include "pipeline/options/ingest_outcome.h"
#include "stormcellar/cache/store.h"
#include "stormcellar/catalog/catalog.h"
#include "stormcellar/level2/decode.h"

namespace stormcellar::pipeline {

struct IngestContext {
    // If `store` is null, files are only registered.
    IngestContext(catalog::CatalogWriter& catalog, cache::StoreWriter* store,
                  IngestOptions options);

    catalog::CatalogWriter& catalog;
    cache::StoreWriter* store;
    const IngestOptions options;
    MosaicMaker mosaics;
    std::optional<SiteGrids> site_grids;  // set if there is a store
    std::optional<FollowedFiles> living;  // set if volumes are gridded while they grow
    ChunkVolumes chunks;
    OpenArchives archives;
    std::atomic<int> running{0};  // files that are being ingested at this moment

    // Returns the number of threads that each of the running files may use.
    [[nodiscard]] int share_of(int threads) const { return std::max(1, threads / running.load()); }
    [[nodiscard]] level2::DecodeOptions decode_options_for(const std::string& station) const;

    // Returns the station if its data are accepted, else an empty text.
    [[nodiscard]] std::string taken_station(const std::string& station) const;
    // Tells the rule for stations that decoded data of this station have come. The rule may then
    // accept a new name.
    void admit(const std::string& station) const;

    // Writes the row of a file. If the file's station is not accepted, stores the row among the
    // files of unknown stations.
    Status record(catalog::FileFacts facts);
    // Records the file as rejected, and returns the outcome. Errors: the row cannot be stored.
    Result<IngestOutcome> reject(const catalog::FileFacts& facts, Error why, IngestOutcome outcome);
    // Rejects a file that was not examined. Its row does not settle it, so it is tried again when
    // it is next offered. `size_bytes` is 0 if the size is unknown.
    Result<IngestOutcome> reject_unread(const std::filesystem::path& path, const Error& why,
                                        std::uint64_t size_bytes = 0);
    // Registers the file as seen, unless it has a row, and returns the outcome `incomplete`.
    Result<IngestOutcome> wait_unread(catalog::FileFacts facts, IngestOutcome outcome);
    // Registers the file as seen, unless it has a row.
    Status note_seen(catalog::FileFacts facts);
    // Marks the rows of a file that is gone, and stops following it.
    Status mark_gone(const std::filesystem::path& path);
};

// Counts a file while the file is being ingested.
class Running {
  public:
    explicit Running(IngestContext& context) : count_(context.running) { ++count_; }
    Running(const Running&) = delete;
    Running& operator=(const Running&) = delete;
    ~Running() { --count_; }

  private:
    std::atomic<int>& count_;
};

// Returns the facts of a file that was not decoded: its path, size and modification time, and this
// station.
[[nodiscard]] catalog::FileFacts facts_unread(const std::filesystem::path& path,
                                              const FileStamp& stamp, std::string station);
// Returns the station in the file's name or, for a chunk, in its path (station_of_path()).
[[nodiscard]] std::string station_of_name(const std::filesystem::path& path);
// Returns the reason without the path at its start, because the catalog stores the path separately.
[[nodiscard]] std::string without_path(const std::string& message,
                                       const std::filesystem::path& path);

}  // namespace stormcellar::pipeline
