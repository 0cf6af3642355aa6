// pipeline/mend_cache.h -- grids that are damaged or missing are made again from their raw files.
//
// A grid that another program cut or altered, or that the disk cannot give, is dropped and made
// again when its raw file is still there as the catalog has it. Which missing grids are made again:
// those of the newest volumes (`newest` before the station's latest, stamps of more than 10 minutes
// in the future not counted) that are newer than the oldest grid which stands in their domain, or
// any of these when the domain holds none. So what was evicted, oldest first, is never filled in
// again, and a cache that was wiped is.
// Thread contract: as the catalog, the store and the ingestor; one grid is mended by one thread.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "cache/store.h"
#include "catalog/catalog.h"
#include "pipeline/ingest.h"

namespace stormcellar::pipeline {

struct MissingGrid {
    std::string station;
    UtcTime time;
    std::filesystem::path raw;  // the best file of this volume: a whole one, then the newest
};

enum class GridCondition {
    sound,
    made_again,  // was damaged; stands again
    dropped,     // was damaged; no raw file of it is left, or that could not be gridded
    left_alone,  // cannot be judged: no permission, no descriptors, of a later version
};
struct MendedGrid {
    GridCondition condition = GridCondition::sound;
    std::string reason;         // what is wrong; begins with the path
    std::filesystem::path raw;  // made_again: from which file
};

enum class MendDepth {
    header,  // magic, sizes, and the checksum of all but the codes: fast
    all,     // every byte
};

class CacheMender {
  public:
    // All must outlive it. `moment` is what the ingestor grids.
    CacheMender(catalog::Catalog& catalog, const cache::Store& store, Ingestor& ingestor,
                level2::Moment moment);

    // Errors: the damaged grid cannot be removed, or the catalog or cache cannot be written.
    Result<MendedGrid> mend(const cache::StoreEntry& entry, MendDepth depth);

    // Newest first. Errors: the catalog or the cache cannot be read.
    Result<std::vector<MissingGrid>> missing(std::chrono::milliseconds newest);
    Result<IngestOutcome> make(const MissingGrid& grid);

  private:
    Result<std::optional<std::filesystem::path>> raw_of(const std::string& station, UtcTime time);
    Result<std::vector<MissingGrid>> missing_of(const std::string& station,
                                                std::chrono::milliseconds newest);

    catalog::Catalog& catalog_;
    const cache::Store& store_;
    Ingestor& ingestor_;
    level2::Moment moment_;
};

}  // namespace stormcellar::pipeline
