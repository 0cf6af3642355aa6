// pipeline/care/archive_fill.h -- grids the raw files of an archive into a cache, as the daemon
// does.
//
// The chain that the daemon uses (pipeline/ingest/ingest.h) reads, grids and commits the volumes,
// several at a time. For a domain, the partials (grids of single sites) are made first, and then
// each frame (the merged grid of an instant), once (pipeline/mosaic/mosaic_maker.h). A grid that
// the cache already has is kept if its raw file has not changed since and the grid has the
// requested grid spec. A frame is kept if neither its partials nor the rules for frames have
// changed since it was made. So a second call continues where the first call ended, even after a
// crash, because each grid is written whole or not at all. The report names the files that are left
// out: files that are gone, have nothing to grid, or have changed since they were cataloged
// (stormcellar/catalog/read_cataloged.h). Open the store so that nobody else writes to it.
//
// Memory    As many decoded volumes as there are workers (at most most_workers), and their grids.
// Threads   One thread at a time may use an ArchiveFill. `progress` is called from its workers, one
//           call at a time. Any thread may set `stop`.
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
    // Says how velocities are dealiased and which echo is left out. The motion of SRV is the
    // default.
    retrieve::DerivedOptions derived = {};
    std::optional<Domain> domain;  // none: each station alone, with the following grid
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
    std::size_t volumes = 0;                        // number of requested volumes
    std::size_t grids_made = 0;                     // for volumes
    std::size_t grids_found = 0;                    // for volumes, already in the cache
    std::size_t frames_made = 0, frames_found = 0;  // for a domain
    std::vector<LeftOut> left_out;                  // by path
    std::vector<LeftOut> notes;  // remarks on gridded files and on frames (without a path)
    // For a domain: instants in the range that have a frame, ascending.
    std::vector<UtcTime> frames;
};

using FillProgress = std::function<void(std::size_t done)>;

// Returns the options with which the chain makes grids for these options of an archive.
[[nodiscard]] IngestOptions ingest_options(const ArchiveOptions& options);
// Returns true if the provenance of a grid tells of the quality, the storm motion, the assumed
// height of 0 C and the rung of dealiasing that these options give. The notes of VELD do not name
// the rung, and those of a mosaic may lack it; then any rung passes. So does every rung if the
// options leave the choice to each volume.
[[nodiscard]] bool is_derived_as(const retrieve::DerivedOptions& options,
                                 const cache::GridDescription& description);
// Returns true if the grid of a volume has the shape and place that these options give, and is
// derived as the options say.
[[nodiscard]] bool is_of_grid(const ArchiveOptions& options,
                              const cache::GridDescription& description);
// Returns the reason why the chain made no grid from a file.
[[nodiscard]] std::string reason_left_out(const IngestOutcome& outcome, level2::Moment moment);
// Estimates the size on disk of the grids of this many volumes and, with a domain, of the frames.
// The estimate is high: for grids with little echo, two to four times the real size.
[[nodiscard]] std::uint64_t bytes_of_grids(const ArchiveOptions& options, std::size_t volumes,
                                           std::size_t frames);

class ArchiveFill {
  public:
    // `catalog` knows the volumes. The chain keeps a catalog of its own in the directory `scratch`.
    // The catalog, the store and the directory must outlive the object.
    ArchiveFill(const catalog::CatalogReader& catalog, cache::StoreWriter& store,
                std::filesystem::path scratch, ArchiveOptions options);

    // Returns the volumes whose grids fill() must make.
    [[nodiscard]] Result<std::vector<ArchiveVolume>> missing(
        const std::vector<ArchiveVolume>& volumes) const;
    // Instants within 30 minutes of a volume, and how many of these have no frame.
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

    // Grids the volumes, and reports the files that were left out. Once `stop` is set, begins no
    // further volume. Errors: the cache or the scratch directory cannot be written, or the disk is
    // full. Faults of the data are not errors.
    [[nodiscard]] Status fill(const std::vector<ArchiveVolume>& missing,
                              const FillProgress& progress, const std::atomic<bool>& stop,
                              FillReport& report);
    // Makes the domain's frames at those of the instants that have volumes around them. Does
    // nothing if there is no domain.
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
