// pipeline/keep/site_grids.h -- volumes of a site -> grids around the site in the cache.
//
// Inside the pipeline room only. Thread contract: many threads may use it at once.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

#include "pipeline/keep/geometry_cache.h"
#include "pipeline/options/ingest_options.h"
#include "pipeline/options/ingest_outcome.h"
#include "stormcellar/base/result.h"
#include "stormcellar/cache/store.h"
#include "stormcellar/grid/gridder.h"

namespace stormcellar::pipeline {

// What the provenance of the grid says about the raw file.
struct GridSource {
    std::string file;  // without directories
    std::int64_t modified_ns = 0;
    bool partial = false;
    std::vector<std::string> radar_troubles = {};
    std::vector<std::string> notes = {};
};

class SiteGrids {
  public:
    SiteGrids(cache::StoreWriter& store, const IngestOptions& options)
        : store_(store), options_(options) {}

    // Returns true if the position of the radar is known; otherwise the outcome says so.
    [[nodiscard]] static bool has_place(const level2::Volume& volume, IngestOutcome& outcome);

    // Grids a volume, audits the grid and commits it, unless the cache has a better one or its
    // limits do not keep it; then the outcome says so. Adds to the outcome's grids and times.
    Status keep(const level2::Volume& volume, const GridSource& source, int threads,
                IngestOutcome& outcome);
    // The same for a growing volume, in a hurry: the grid is neither audited nor synced, because it
    // is replaced within seconds and made again after a crash. Adds to the outcome's `living`.
    Status keep_living(const level2::Volume& volume, const GridSource& source, int threads,
                       IngestOutcome& outcome);

  private:
    struct Made {
        grid::Grid grid;
        grid::GridderOptions gridder;
    };
    Result<Made> make(const level2::Volume& volume, const GridSource& source, int threads);
    Result<std::filesystem::path> commit(Made& made, const level2::Volume& volume, bool is_living,
                                         IngestOutcome& outcome);

    cache::StoreWriter& store_;
    const IngestOptions& options_;
    // The geometry of the default grid takes a few MiB.
    static constexpr std::size_t kept_geometries = 16;
    GeometryCache geometries_{kept_geometries};
    // Allows one commit at a time for each grid file, by the hash of its path.
    std::array<std::mutex, 16> commits_;
};

// Blames the file for an error in gridding a decoded volume, whatever its code, unless the system
// was short of something.
[[nodiscard]] tl::unexpected<Error> of_gridding(Error error);
// Blames the system for an error in writing to the cache, whatever its code.
[[nodiscard]] tl::unexpected<Error> of_storing(Error error);
// Notes that the limits of the cache leave no room for a grid, so that somebody would have to
// change them: the file is not tried again until a restart looks for missing grids.
void note_no_room(IngestOutcome& outcome, const Error& why);
// Notes that the cache keeps no grid of this station that is so old, or no grid of an unknown
// station.
void note_not_kept(const std::string& station, IngestOutcome& outcome);

}  // namespace stormcellar::pipeline
