// pipeline/ingest/ingest_context.h -- state and functions that the handlers of all kinds of files
// share: where they write, what they remember of growing files, and how they write catalog rows.
//
// Inside the pipeline room only. Thread contract: that of Ingestor; many threads may call all
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

    // Returns the number of threads that one of the running files may use.
    [[nodiscard]] int share_of(int threads) const { return std::max(1, threads / running.load()); }
    [[nodiscard]] level2::DecodeOptions decode_options_for(const std::string& station) const;

    // Returns the station if its data are accepted, otherwise an empty text.
    [[nodiscard]] std::string taken_station(const std::string& station) const;
    // Notes that complete data of this station have come: the rule may then accept a new name.
    void admit(const std::string& station) const;

    // Writes the row of a file. If the file's station is not accepted, the row is stored with those
    // of no known station.
    Status record(catalog::FileFacts facts);
    // Records the file as rejected. Returns the outcome, or the error if that cannot be stored.
    Result<IngestOutcome> reject(const catalog::FileFacts& facts, Error why, IngestOutcome outcome);
    // Rejects a file that was not examined. The stamp in its row settles nothing, so it is tried
    // again when it is offered again. `size_bytes` is 0 if unknown.
    Result<IngestOutcome> reject_unread(const std::filesystem::path& path, const Error& why,
                                        std::uint64_t size_bytes = 0);
    // Records that the file exists and is incomplete.
    Result<IngestOutcome> wait_unread(catalog::FileFacts facts, IngestOutcome outcome);
    // Does the same without an outcome. An existing row stays as it is.
    Status note_seen(catalog::FileFacts facts);
    // Marks the rows of a file that is gone, and stops following it.
    Status mark_gone(const std::filesystem::path& path);
};

// Counts a file while it is being ingested.
class Running {
  public:
    explicit Running(IngestContext& context) : count_(context.running) { ++count_; }
    Running(const Running&) = delete;
    Running& operator=(const Running&) = delete;
    ~Running() { --count_; }

  private:
    std::atomic<int>& count_;
};

// Returns the facts of a file that was not decoded: its path and stamp, and this station.
[[nodiscard]] catalog::FileFacts facts_unread(const std::filesystem::path& path,
                                              const FileStamp& stamp, std::string station);
// Returns the station in the file's name, or for a chunk in the names of its directories.
[[nodiscard]] std::string station_of_name(const std::filesystem::path& path);
// Returns the reason without the path at its beginning, because the catalog stores the path
// separately.
[[nodiscard]] std::string without_path(const std::string& message,
                                       const std::filesystem::path& path);

}  // namespace stormcellar::pipeline
