// pipeline/care/archive_fill.h -- grids the raw files of an archive into a cache, as the daemon
// does.
//
// The daemon's own chain (pipeline/ingest/ingest.h) reads, grids and commits the volumes, several
// at a time. For a domain, the partials (grids of single sites) are made first, then each frame
// (the merged grid of an instant) once (pipeline/mosaic/mosaic_maker.h). A volume's grid that the
// cache already has is kept if it was made from the present file and has the requested grid spec. A
// frame is kept if it was made from the present partials by the present rules. So a second call
// continues where the first one ended, even after a crash, because grids appear whole. The report
// names files that are left out: files that are gone, have nothing to grid, or are no longer the
// cataloged ones (stormcellar/catalog/read_cataloged.h). Open the store so that no one else writes
// to it.
//
// Memory    As many decoded volumes as there are workers (at most most_workers), and their grids.
// Threads   An ArchiveFill is for one thread at a time. `progress` is called from its workers, one
//           at a time. Any thread may set `stop`.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "pipeline/drop/archive_volumes.h"
#include "pipeline/options/domain.h"
#include "pipeline/options/ingest_options.h"
#include "pipeline/options/ingest_outcome.h"
#include "stormcellar/base/result.h"
#include "stormcellar/cache/store.h"

namespace stormcellar::pipeline {

inline constexpr int most_workers = 8;

struct ArchiveOptions {
    level2::Moment moment = level2::Moment::ref;
    std::optional<Domain> domain;  // none: each station's own grid, with the following shape
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
    std::size_t volumes = 0;                        // requested
    std::size_t grids_made = 0;                     // of volumes
    std::size_t grids_found = 0;                    // already in the cache
    std::size_t frames_made = 0, frames_found = 0;  // of a domain
    std::vector<LeftOut> left_out;                  // by path
    std::vector<LeftOut> notes;   // remarks on gridded files and on frames (without a path)
    std::vector<UtcTime> frames;  // of a domain: frames in the range that exist, ascending
};

using FillProgress = std::function<void(std::size_t done)>;

// Returns the options with which the daemon's chain grids for such a cache.
[[nodiscard]] IngestOptions ingest_options(const ArchiveOptions& options);
// Returns true if the grid of a volume has the shape and place of these options.
[[nodiscard]] bool is_of_grid(const ArchiveOptions& options,
                              const cache::GridDescription& description);
// Returns why the chain made no grid from a file.
[[nodiscard]] std::string reason_left_out(const IngestOutcome& outcome, level2::Moment moment);
// Estimates the bytes on disk of this many grids of volumes and, with a domain, frames. The
// estimate is high: two to four times the size of grids with little echo.
[[nodiscard]] std::uint64_t bytes_of_grids(const ArchiveOptions& options, std::size_t volumes,
                                           std::size_t frames);

class ArchiveFill {
  public:
    // `catalog` has the volumes. The chain makes its own catalog in the directory `scratch`. The
    // catalog, the store and the directory must outlive the object.
    ArchiveFill(const catalog::CatalogReader& catalog, cache::StoreWriter& store,
                std::filesystem::path scratch, ArchiveOptions options);

    // Returns the volumes whose grids fill() must make.
    [[nodiscard]] Result<std::vector<ArchiveVolume>> missing(
        const std::vector<ArchiveVolume>& volumes) const;
    // Instants within 30 minutes of a volume, and how many of them have no frame.
    struct DueFrames {
        std::vector<UtcTime> instants;
        std::size_t missing = 0;
    };
    // Finds the due frames. The options must have a domain.
    [[nodiscard]] Result<DueFrames> due(const std::vector<UtcTime>& instants,
                                        const std::vector<ArchiveVolume>& volumes) const;
    [[nodiscard]] std::uint64_t bytes_of(std::size_t volumes, std::size_t frames) const {
        return bytes_of_grids(options_, volumes, frames);
    }

    // Grids the volumes and reports the files that were left out. When `stop` is set, no further
    // volume begins. Errors: the cache or the scratch directory cannot be written, or the disk is
    // full. Faults of the data are not errors.
    [[nodiscard]] Status fill(const std::vector<ArchiveVolume>& missing,
                              const FillProgress& progress, const std::atomic<bool>& stop,
                              FillReport& report);
    // Makes the domain's frames at the instants that have volumes around them. Does nothing without
    // a domain.
    [[nodiscard]] Status make_frames(const std::vector<UtcTime>& instants,
                                     const FillProgress& progress, const std::atomic<bool>& stop,
                                     FillReport& report);

  private:
    [[nodiscard]] Result<bool> stands(const ArchiveVolume& volume) const;
    [[nodiscard]] std::string domain_of(const ArchiveVolume& volume) const;

    [[nodiscard]] Result<std::filesystem::path> root_of(
        const std::vector<ArchiveVolume>& volumes) const;

    const catalog::CatalogReader& catalog_;
    cache::StoreWriter& store_;
    std::filesystem::path scratch_;
    ArchiveOptions options_;
};

}  // namespace stormcellar::pipeline
