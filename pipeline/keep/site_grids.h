// pipeline/keep/site_grids.h -- grids volumes on the own grid of their site, and puts the grids
// into the cache. Used only inside the pipeline room.
//
// Threads   Many threads may use one object.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
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

// Facts about the raw file of a volume.
struct GridSource {
    std::string file;  // without directories
    bool partial = false;
    bool has_rival = false;  // another file of this volume exists
    std::vector<std::string> radar_troubles = {};
    std::vector<std::string> notes = {};
};

class SiteGrids {
  public:
    SiteGrids(cache::StoreWriter& store, const IngestOptions& options)
        : store_(store), options_(options), derived_(options.derived) {
        derived_.quality = 0;  // volumes come without improbable echo
    }

    // Returns true if the volume has a station and the radar's position is known. Otherwise notes
    // in the outcome which of the two is missing.
    [[nodiscard]] static bool has_place(const level2::Volume& volume, IngestOutcome& outcome);

    // Grids each of the moments that the volume holds, audits the grids, and commits them. The
    // caller must first remove the echo that is to be left out. Drops a new grid if a better one
    // exists (pipeline/keep/keep_rule.h) or the cache's budgets do not keep it; the outcome says
    // so. The outcome also says why a moment cannot be derived, for example SRV if the wind profile
    // is too short. Adds the times, and the paths of the grids (also of better grids that stay), to
    // the outcome. Calls `use_dealiased`, if given, with the volume's velocities and their VELD, if
    // it was made.
    Status keep(const level2::Volume& volume, const GridSource& source, int threads,
                IngestOutcome& outcome,
                const std::function<void(const level2::Volume&)>& use_dealiased = {});
    // Grids one moment of a growing volume and commits the grid, like keep(). Neither audits nor
    // syncs the grid, because it is replaced in seconds and made again after a crash. Adds the path
    // to the outcome's `living`.
    Status keep_living(const level2::Volume& volume, level2::Moment moment,
                       const GridSource& source, int threads, IngestOutcome& outcome);

  private:
    struct Made {
        grid::Grid grid;
        grid::GridderOptions gridder;
    };
    // The volume from which a moment is gridded, and its source.
    struct UsedVolume {
        const level2::Volume* volume = nullptr;  // null: the moment cannot be derived
        GridSource source;
    };
    [[nodiscard]] Result<UsedVolume> used_volume(const level2::Volume& measured,
                                                 level2::Moment moment, const GridSource& source,
                                                 std::optional<level2::Volume>& dealiased,
                                                 std::optional<level2::Volume>& judged,
                                                 IngestOutcome& outcome) const;
    Status keep_moment(const level2::Volume& measured, level2::Moment moment,
                       const GridSource& source, int threads,
                       std::optional<level2::Volume>& dealiased, IngestOutcome& outcome);
    Result<Made> make(const level2::Volume& volume, level2::Moment moment, const GridSource& source,
                      int threads);
    enum class Living { no, yes };
    Result<std::filesystem::path> commit(Made& made, const level2::Volume& volume,
                                         const GridSource& source, Living living,
                                         IngestOutcome& outcome);

    cache::StoreWriter& store_;
    const IngestOptions& options_;
    retrieve::DerivedOptions derived_;
    // Number of geometries that are kept. The geometry of the default grid takes a few MiB.
    static constexpr std::size_t kept_geometries = 16;
    GeometryCache geometries_{kept_geometries};
    // One thread at a time may commit a grid file. The hash of the file's path selects the mutex.
    std::array<Mutex, 16> commits_;
};

// Sets the cause of an error of gridding a decoded volume. The cause is the file, unless the code
// is io, exhausted or no_space.
[[nodiscard]] tl::unexpected<Error> of_gridding(Error error);
// Sets the cause of an error of writing into the cache. The cause is never the file.
[[nodiscard]] tl::unexpected<Error> of_storing(Error error);
// Notes that a derived moment cannot be made.
void note_not_derived(level2::Moment moment, const Error& why, IngestOutcome& outcome);
// Notes that the cache's budgets leave no room for a grid, so that an operator must change them.
// The file is not tried again until a restart looks for missing grids.
void note_no_room(IngestOutcome& outcome, const Error& why);
// Notes that a grid is too old for the cache or, for an unknown station, that the cache has no room
// left for unknown stations.
void note_not_kept(const std::string& station, IngestOutcome& outcome);

}  // namespace stormcellar::pipeline
