// pipeline/care/mend_cache.h -- makes grids again that are damaged or missing.
//
// A grid is damaged if another program truncated or altered it, or if the disk cannot return it. A
// site's own grid, or a partial of a mosaic (NAME.ICAO), is removed and made again from the raw
// file, if that still exists as cataloged. A frame of a mosaic is made again from its partials. A
// damaged grid that cannot be made again is removed, unless a failing disk is the only sign of
// damage.
//
// A missing grid is made again only if its volume is within `newest` of the station's latest volume
// and newer than the oldest grid in the domain. If the domain has no grid, only the first condition
// applies. Volumes more than 10 minutes in the future do not count. So evicted grids, which are the
// oldest, are never made again, but an emptied cache is filled. A grid that could not be made is
// not tried again while the object exists.
//
// Threads   One thread at a time, within the rules of the catalog, the store and the ingestor.
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
    std::filesystem::path raw;  // a complete file of this volume, else the one with the latest end
    std::vector<cache::GridName> names;  // the missing grids
};

enum class GridCondition {
    sound,
    made_again,  // was damaged, and exists again
    dropped,     // was damaged, and cannot be made again
    left_alone,  // cannot be judged: no permission, no descriptors, or a later version
};
struct MendedGrid {
    GridCondition condition = GridCondition::sound;
    std::string reason;   // the damage, with the path first; empty: sound
    std::string from;     // made_again: the raw file, or "the partials of KBGM, KOKX"
    std::string why_not;  // dropped: why it was not made again
};

enum class MendDepth {
    header,  // magic, sizes, and the checksum of everything but the codes: fast
    all,     // every byte
};

class CacheMender {
  public:
    // The catalog, the store and the ingestor must outlive the object. `moments` are the moments of
    // the sites' own grids that the ingestor makes.
    CacheMender(const catalog::CatalogReader& catalog, cache::StoreWriter& store,
                Ingestor& ingestor, std::vector<level2::Moment> moments);

    // Checks a grid, and repairs or removes it if it is damaged. Errors: the damaged grid cannot be
    // removed, or the catalog or the cache cannot be read or written.
    Result<MendedGrid> mend(const cache::StoreEntry& entry, MendDepth depth);

    // Returns missing grids, newest first. A station whose database or grids cannot be read is left
    // out. `step` is called after each station, so that the caller can see progress. Errors: the
    // catalog's stations cannot be listed, or is_shortage() while a station's grids are listed.
    Result<std::vector<MissingGrid>> missing(std::chrono::milliseconds newest,
                                             const std::function<void()>& step = {});
    // Makes the missing grids of a volume. Errors: corrupt if the raw file is not the cataloged
    // one; those of Ingestor::ingest_again().
    Result<IngestOutcome> make(const MissingGrid& grid);

    // Returns missing frames of mosaics, newest first. Call it after the partials were made.
    // Errors: the cache cannot be read.
    Result<std::vector<cache::GridName>> missing_frames(std::chrono::milliseconds newest);
    // Makes a frame and returns its source, as in MendedGrid::from. Returns none if no domain has
    // the frame, if no partials are near it, or if the cache's limits do not keep it.
    Result<std::optional<std::string>> make(const cache::GridName& frame);

  private:
    // One kind of grid that a station's volumes have.
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
    // Returns why a grid of the station's volume at this time has no file to be made from.
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
