// pipeline/keep/site_grids.h -- volumes of one site -> grids about it in the cache.
//
// Inside the pipeline room only. Thread contract: may be used by many threads at once.
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

// What the grid's provenance is to say of the raw file.
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

    // Whether somebody knows where the radar stands; if not the outcome says so.
    [[nodiscard]] static bool has_place(const level2::Volume& volume, IngestOutcome& outcome);

    // Grids a volume, audits it and commits the grid, unless a better one stands or the budgets do
    // not keep it: then the outcome says so. Adds to its grids and times.
    Status keep(const level2::Volume& volume, const GridSource& source, int threads,
                IngestOutcome& outcome);
    // The same of a volume that still grows, in a hurry: not audited, and not synced, for it will
    // be replaced in seconds and made again after a crash. Adds to the outcome's `living`.
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
    // A geometry of the default grid takes a few MiB.
    static constexpr std::size_t kept_geometries = 16;
    GeometryCache geometries_{kept_geometries};
    // One commit at a time for each grid file, by the hash of its path.
    std::array<std::mutex, 16> commits_;
};

// An error of gridding a volume that was decoded: whatever it is called, it lies in what the file
// says, unless the system refused something.
[[nodiscard]] tl::unexpected<Error> of_gridding(Error error);
// An error of writing into the cache: whatever it is called, it does not lie in what was decoded.
[[nodiscard]] tl::unexpected<Error> of_storing(Error error);
// The cache's budgets leave no room for a grid, and somebody would have to change them: the file is
// not tried again until a restart looks for missing grids.
void note_no_room(IngestOutcome& outcome, const Error& why);
// The cache keeps no grid of this station that is so old, or none at all where nobody knows it.
void note_not_kept(const std::string& station, IngestOutcome& outcome);

}  // namespace stormcellar::pipeline
