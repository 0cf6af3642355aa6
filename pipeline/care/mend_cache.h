// pipeline/care/mend_cache.h -- makes damaged and missing grids again.
//
// If another program cut or altered a grid, or the disk cannot read it, the grid is removed and
// made again. A site's own grid and a partial of a mosaic (NAME.ICAO) are made from the raw file if
// it is still the one that was cataloged; a frame of a mosaic is made from the partials that are
// there.
//
// A missing grid is made again if its volume is one of the newest (at most `newest` before the
// station's latest; time stamps more than 10 minutes in the future do not count), and if it is
// newer than the oldest grid of its domain or the domain holds none. So a grid that was evicted
// (the oldest go first) is not made again, and a cache that was emptied is filled. What could not
// be made is not tried again while the object lives. Thread contract: use it from one thread; the
// catalog, the store and the ingestor keep their own contracts.
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

// A volume that lacks a grid: the site's own grid, or partials of mosaics.
struct MissingGrid {
    std::string station;
    UtcTime time;
    std::filesystem::path raw;  // the best file of this volume: a complete one, then the newest
    std::vector<cache::GridName> names;  // the missing grids
};

enum class GridCondition {
    sound,
    made_again,  // was damaged, and was made again
    dropped,     // was damaged, and cannot be made again
    left_alone,  // cannot be judged: no permission, no descriptors, or from a later version
};
struct MendedGrid {
    GridCondition condition = GridCondition::sound;
    std::string reason;   // what is wrong, with the path first
    std::string from;     // made_again: the raw file, or "the partials of KBGM, KOKX"
    std::string why_not;  // dropped: why it was not made again
};

enum class MendDepth {
    header,  // magic, sizes, and the checksum of all but the codes: fast
    all,     // every byte
};

class CacheMender {
  public:
    // All arguments must outlive it. `moment` is the moment that the ingestor grids.
    CacheMender(const catalog::CatalogReader& catalog, cache::StoreWriter& store,
                Ingestor& ingestor, level2::Moment moment);

    // Errors: the damaged grid cannot be removed, or the catalog or cache cannot be written.
    Result<MendedGrid> mend(const cache::StoreEntry& entry, MendDepth depth);

    // Newest first. Errors: the catalog or the cache cannot be read. A station whose own database
    // or grids cannot be read is left out; the troubles of the catalog name it. `step` is called
    // after each station, so that a watchdog sees progress.
    Result<std::vector<MissingGrid>> missing(std::chrono::milliseconds newest,
                                             const std::function<void()>& step = {});
    // Errors: corrupt if the raw file is not the one that was cataloged; those of
    // Ingestor::ingest_again().
    Result<IngestOutcome> make(const MissingGrid& grid);

    // Frames of mosaics, newest first; call it after the partials are made. Errors: the cache
    // cannot be read.
    Result<std::vector<cache::GridName>> missing_frames(std::chrono::milliseconds newest);
    // Returns what the frame was made from, as in MendedGrid; none if no partials are near it, or
    // if the limits do not keep it.
    Result<std::optional<std::string>> make(const cache::GridName& frame);

  private:
    // One kind of grid that the volumes of a station have.
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
    level2::Moment moment_;
    std::set<cache::GridName> failed_;  // not tried again
};

}  // namespace stormcellar::pipeline
