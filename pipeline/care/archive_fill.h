// pipeline/care/archive_fill.h -- raw files of an archive -> grids in a cache, as the daemon makes
// them.
//
// The volumes are read, gridded and committed by the daemon's own chain (pipeline/ingest/ingest.h),
// some at a time; of a domain the sites' partials first and then each frame once
// (pipeline/mosaic/mosaic_maker.h). What stands in the cache already is taken as it is: a grid
// made of this file as it now is, on this grid; a frame made of these partials by these rules. So a
// second call goes on where the first one was ended, however that happened, for grids appear whole.
// A file that is gone, or holds nothing that can be gridded, is named and left out. So is one that
// is not the file that was cataloged (stormcellar/catalog/read_cataloged.h): another that took its
// place, or a link in its path.
//
// The store should have been opened so that nobody else writes to it (RollingStore::open()).
// Memory: as many decoded volumes as there are workers (at most most_workers), and their grids.
// Thread contract: an ArchiveFill is for one thread; `progress` is called from its workers, one at
// a time. `stop` may be set by any thread.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/drop/archive_volumes.h"
#include "pipeline/options/domain.h"
#include "stormcellar/base/result.h"
#include "stormcellar/cache/store.h"

namespace stormcellar::pipeline {

inline constexpr int most_workers = 8;

struct ArchiveOptions {
    level2::Moment moment = level2::Moment::ref;
    std::optional<Domain> domain;  // none: each station's own grid, of the shape that follows
    double spacing_m = 1000;
    int nx = 460, ny = 460;
    std::vector<double> levels_m;  // empty: the default 32
    int threads = 1;
};

struct LeftOut {
    std::filesystem::path path;
    std::string reason;
};

struct FillReport {
    std::size_t volumes = 0;                        // asked for
    std::size_t grids_made = 0;                     // of volumes
    std::size_t grids_found = 0;                    // stood in the cache
    std::size_t frames_made = 0, frames_found = 0;  // of a domain
    std::vector<LeftOut> left_out;                  // by path
    std::vector<LeftOut> notes;   // gridded, but something is worth saying, as that it is in part
    std::vector<UtcTime> frames;  // of a domain: those that stand within the range, rising
};

using FillProgress = std::function<void(std::size_t done)>;

class ArchiveFill {
  public:
    // `catalog`: where the volumes were found. `scratch`: a directory for the chain's own catalog,
    // which is made there. All must outlive it.
    ArchiveFill(const catalog::CatalogReader& catalog, cache::StoreWriter& store,
                std::filesystem::path scratch, ArchiveOptions options);

    // The volumes of which no grid stands, to be made by fill().
    [[nodiscard]] Result<std::vector<ArchiveVolume>> missing(
        const std::vector<ArchiveVolume>& volumes) const;
    // Those of the instants that a volume is near enough to, and how many of them have no frame.
    struct DueFrames {
        std::vector<UtcTime> instants;
        std::size_t missing = 0;
    };
    [[nodiscard]] Result<DueFrames> due(const std::vector<UtcTime>& instants,
                                        const std::vector<ArchiveVolume>& volumes) const;
    // What their grids, and with a domain `frames` frames, take on disk: a guess on the safe side,
    // two to four times what grids with little echo take.
    [[nodiscard]] std::uint64_t bytes_of(std::size_t volumes, std::size_t frames) const;

    // Grids them. Errors: those that are not of the data (the cache or the scratch directory cannot
    // be written, the disk is full). When `stop` is set no volume begins any more.
    [[nodiscard]] Status fill(const std::vector<ArchiveVolume>& missing,
                              const FillProgress& progress, const std::atomic<bool>& stop,
                              FillReport& report);
    // The frames of the domain at these instants, as far as volumes stand about them.
    [[nodiscard]] Status make_frames(const std::vector<UtcTime>& instants,
                                     const FillProgress& progress, const std::atomic<bool>& stop,
                                     FillReport& report);

  private:
    [[nodiscard]] Result<bool> stands(const ArchiveVolume& volume) const;
    [[nodiscard]] bool is_of_this_grid(const cache::GridDescription& description) const;
    [[nodiscard]] std::string domain_of(const ArchiveVolume& volume) const;

    [[nodiscard]] Result<std::filesystem::path> root_of(
        const std::vector<ArchiveVolume>& volumes) const;

    const catalog::CatalogReader& catalog_;
    cache::StoreWriter& store_;
    std::filesystem::path scratch_;
    ArchiveOptions options_;
};

}  // namespace stormcellar::pipeline
