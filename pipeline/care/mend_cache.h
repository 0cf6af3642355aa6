// pipeline/care/mend_cache.h -- makes damaged and missing grids again.
//
// A grid is damaged if another program truncated or altered it, or if the disk cannot return it. A
// damaged grid of a site, or a damaged partial of a mosaic (NAME.ICAO), is removed and made again
// from the raw file, if the raw file is still as it was cataloged. A frame of a mosaic is made
// again from its partials. A damaged grid that cannot be made again is removed, unless a failing
// disk is the only sign of damage.
//
// A missing grid is made again only if its volume is at most `newest` older than the station's
// latest volume, and newer than the oldest grid in the domain. If the domain has no grid, only the
// first condition applies. Volumes more than 10 minutes in the future do not count. So evicted
// grids, which are the oldest, are never made again, but an emptied cache is filled. If a grid
// could not be made, this object does not try it again.
//
// Threads   One thread at a time. The rules of the catalog, the store and the ingestor also apply.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "pipeline/ingest/ingest.h"
#include "pipeline/mosaic/mosaic_maker.h"
#include "stormcellar/base/result.h"
#include "stormcellar/cache/store.h"
#include "stormcellar/catalog/catalog.h"

namespace stormcellar::pipeline {

// A volume with missing grids: the site's own, or partials of mosaics.
struct MissingGrid {
    std::string station;
    UtcTime time;
    std::filesystem::path raw;  // a complete file of the volume, else the one with the latest end
    std::vector<cache::GridName> names;  // the missing grids
};

enum class GridCondition {
    sound,
    made_again,  // was damaged, and was made again
    dropped,     // was damaged, and cannot be made again
    left_alone,  // cannot be judged: no permission, no descriptors, or a later version
};
struct MendedGrid {
    GridCondition condition = GridCondition::sound;
    std::string reason;   // what is damaged, beginning with the path; empty: sound
    std::string from;     // made_again: the raw file, or "the partials of KBGM, KOKX"
    std::string why_not;  // if dropped: why it was not made again
};

enum class MendDepth {
    header,  // magic, sizes, and the checksum of everything but the codes: fast
    all,     // every byte
};

class CacheMender {
  public:
    // The catalog, the store and the ingestor must outlive the object. `moments` are the moments
    // for which the ingestor makes the sites' own grids.
    CacheMender(const catalog::CatalogReader& catalog, cache::StoreWriter& store,
                Ingestor& ingestor, std::vector<level2::Moment> moments);

    // Checks a grid, and repairs or removes it if it is damaged. Errors: the damaged grid cannot be
    // removed, or the catalog or the cache cannot be read or written.
    Result<MendedGrid> mend(const cache::StoreEntry& entry, MendDepth depth);

    // Returns missing grids, newest first. Leaves out stations whose database or grids cannot be
    // read. Calls `step` after each station, so that the caller sees progress. Errors: the stations
    // of the catalog cannot be listed; or listing a station's grids fails with a shortage
    // (is_shortage()).
    Result<std::vector<MissingGrid>> missing(std::chrono::milliseconds newest,
                                             const std::function<void()>& step = {});
    // Makes the missing grids of a volume. Errors: corrupt if the raw file is not the cataloged
    // one; those of Ingestor::ingest_again().
    Result<IngestOutcome> make(const MissingGrid& grid);

    // Returns missing frames of mosaics, newest first. Call it after the partials were made.
    // Errors: the cache cannot be read.
    Result<std::vector<cache::GridName>> missing_frames(std::chrono::milliseconds newest);
    // Makes a frame. Returns its source, as in MendedGrid::from. Returns none if no domain has the
    // frame, if no partials are near it, or if the cache's budgets do not keep it.
    Result<std::optional<std::string>> make(const cache::GridName& frame);

  private:
    // A kind of grid that is made of a station's volumes.
    struct Series {
        std::string domain;
        level2::Moment moment;
    };
    struct Standing {
        Series series;
        std::set<UtcTime> times;
        UtcTime from;  // older volumes count as evicted
    };
    Result<std::optional<std::filesystem::path>> raw_of(const std::string& station, UtcTime time);
    // Returns the reason why there is no file from which the grid of the station's volume at this
    // time can be made.
    [[nodiscard]] std::string why_not_again(const std::string& station, UtcTime time);
    Result<IngestOutcome> make_from(const std::filesystem::path& raw, const std::string& station);
    Result<MendedGrid> mend_from_raw(const cache::StoreEntry& entry, const std::string& station,
                                     const Error& damage);
    Result<MendedGrid> mend_frame(const cache::StoreEntry& entry, const Error& damage);
    [[nodiscard]] std::vector<Series> series_of(const std::string& station) const;
    Result<std::vector<Standing>> standing_of(const std::string& station, UtcTime oldest);
    Result<std::vector<MissingGrid>> missing_of(const std::string& station,
                                                std::chrono::milliseconds newest);

    const catalog::CatalogReader& catalog_;
    cache::StoreWriter& store_;
    Ingestor& ingestor_;
    std::vector<level2::Moment> moments_;
    std::set<cache::GridName> failed_;  // not tried again
};

}  // namespace stormcellar::pipeline
