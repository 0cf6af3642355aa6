// pipeline/care/archive_fill.h -- makes grids in a cache from the raw files of an archive, as the
// daemon makes them.
//
// The daemon's own chain (pipeline/ingest/ingest.h) reads, grids and commits the volumes, several
// at a time. For a domain it makes the partials of the sites first, and then each frame once
// (pipeline/mosaic/mosaic_maker.h). A grid that is already in the cache is used if it was made from
// this file, as it now is, on this grid; a frame is used if it was made from these partials by
// these rules. Since grids appear only when they are whole, a second call continues where the first
// one ended, however that happened. A file that is gone, or holds nothing that can be gridded, is
// reported and left out. So is a file that is not the one that was cataloged
// (stormcellar/catalog/read_cataloged.h), because another file took its place or a link is in its
// path.
//
// Open the store so that nobody else writes to it (RollingStore::open()). Memory: as many decoded
// volumes as there are workers (at most most_workers), and their grids. Thread contract: use an
// ArchiveFill from one thread. Its workers call `progress`, one at a time. Any thread may set
// `stop`.
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
    std::size_t volumes = 0;                        // requested
    std::size_t grids_made = 0;                     // from volumes
    std::size_t grids_found = 0;                    // already in the cache
    std::size_t frames_made = 0, frames_found = 0;  // of a domain
    std::vector<LeftOut> left_out;                  // by path
    std::vector<LeftOut>
        notes;  // gridded, but worth a note, for example that the volume is incomplete
    std::vector<UtcTime> frames;  // of a domain: the frames in the cache within the range, rising
};

using FillProgress = std::function<void(std::size_t done)>;

class ArchiveFill {
  public:
    // `catalog` is where the volumes were found. The chain makes its own catalog in the directory
    // `scratch`. All arguments must outlive the object.
    ArchiveFill(const catalog::CatalogReader& catalog, cache::StoreWriter& store,
                std::filesystem::path scratch, ArchiveOptions options);

    // The volumes that have no grid yet; fill() makes these grids.
    [[nodiscard]] Result<std::vector<ArchiveVolume>> missing(
        const std::vector<ArchiveVolume>& volumes) const;
    // The instants that are near enough to a volume, and how many of them have no frame.
    struct DueFrames {
        std::vector<UtcTime> instants;
        std::size_t missing = 0;
    };
    [[nodiscard]] Result<DueFrames> due(const std::vector<UtcTime>& instants,
                                        const std::vector<ArchiveVolume>& volumes) const;
    // How much disk space the grids of these volumes take and, with a domain, `frames` frames: a
    // safe estimate, two to four times what grids with little echo take.
    [[nodiscard]] std::uint64_t bytes_of(std::size_t volumes, std::size_t frames) const;

    // Grids the volumes. Errors are those that the data do not cause (the cache or the scratch
    // directory cannot be written, the disk is full). When `stop` is set, no further volume begins.
    [[nodiscard]] Status fill(const std::vector<ArchiveVolume>& missing,
                              const FillProgress& progress, const std::atomic<bool>& stop,
                              FillReport& report);
    // The frames of the domain at these instants, if there are volumes near enough.
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
