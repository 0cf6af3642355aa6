// pipeline/keep/site_grids.h -- grids volumes on their site's own grid, and puts the grids into the
// cache. Used only inside the pipeline room.
//
// Threads   Many threads may use it.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/keep/geometry_cache.h"
#include "pipeline/options/ingest_options.h"
#include "pipeline/options/ingest_outcome.h"
#include "stormcellar/base/mutex.h"
#include "stormcellar/base/result.h"
#include "stormcellar/cache/store.h"
#include "stormcellar/grid/gridder.h"

namespace stormcellar::pipeline {

// Facts about the raw file that the caller knows.
struct GridSource {
    std::string file;  // without directories
    bool partial = false;
    bool has_rival = false;  // as in Candidate
    std::vector<std::string> radar_troubles = {};
    std::vector<std::string> notes = {};
};

class SiteGrids {
  public:
    SiteGrids(cache::StoreWriter& store, const IngestOptions& options)
        : store_(store), options_(options) {}

    // Returns true if the position of the radar is known; if not, the outcome says so.
    [[nodiscard]] static bool has_place(const level2::Volume& volume, IngestOutcome& outcome);

    // Grids each of the moments that the volume holds, audits the grids and commits them. A grid is
    // left out, and the outcome says so, if a better one exists or the cache's limits do not keep
    // it. Adds to the outcome's grids and times.
    Status keep(const level2::Volume& volume, const GridSource& source, int threads,
                IngestOutcome& outcome);
    // Does the same fast for one moment of a volume that is still growing: the grid is neither
    // audited nor synced, because it will be replaced in seconds and made again after a crash. Adds
    // to the outcome's `living`.
    Status keep_living(const level2::Volume& volume, level2::Moment moment,
                       const GridSource& source, int threads, IngestOutcome& outcome);

  private:
    struct Made {
        grid::Grid grid;
        grid::GridderOptions gridder;
    };
    Status keep_moment(const level2::Volume& volume, level2::Moment moment,
                       const GridSource& source, int threads, IngestOutcome& outcome);
    Result<Made> make(const level2::Volume& volume, level2::Moment moment, const GridSource& source,
                      int threads);
    enum class Living { no, yes };
    Result<std::filesystem::path> commit(Made& made, const level2::Volume& volume,
                                         const GridSource& source, Living living,
                                         IngestOutcome& outcome);

    cache::StoreWriter& store_;
    const IngestOptions& options_;
    // The geometry of the default grid takes a few MiB.
    static constexpr std::size_t kept_geometries = 16;
    GeometryCache geometries_{kept_geometries};
    // One commit at a time for each grid file, by the hash of its path.
    std::array<Mutex, 16> commits_;
};

// Classifies an error of gridding a decoded volume: whatever its code, the cause is in the file,
// unless the system refused something.
[[nodiscard]] tl::unexpected<Error> of_gridding(Error error);
// Classifies an error of writing into the cache: whatever its code, the cause is not in the file.
[[nodiscard]] tl::unexpected<Error> of_storing(Error error);
// Notes that the cache's limits leave no room for a grid, so that someone must change them. The
// file is not tried again until a restart looks for missing grids.
void note_no_room(IngestOutcome& outcome, const Error& why);
// Notes that the cache keeps no grid this old of the station, or no grid of an unknown station.
void note_not_kept(const std::string& station, IngestOutcome& outcome);

}  // namespace stormcellar::pipeline
