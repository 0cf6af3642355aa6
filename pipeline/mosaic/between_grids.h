// pipeline/mosaic/between_grids.h -- makes frames of a domain for any instant, from the grids in
// the domain's cache.
//
// Use it for frames that must be closer in time than the grids. There are two kinds of domains:
//   a station's own  grid/mosaic/time_interpolation.h makes the frame from the volumes before and
//                    after the instant. A cell has a time of its own if the grid has the times of
//                    its sweeps; otherwise it has the time of the volume's middle. If sweeps are
//                    undated, the frame at the middle of a volume is its grid, code by code.
//   a mosaic         The frame is made from the sites' partials (NAME.ICAO), by the rules of the
//                    mosaic's frames (pipeline/mosaic/mosaic_frame.h). At the instant of a mosaic's
//                    frame, the new frame equals the mosaic's frame, code by code.
//
// Gaps      There is no frame between volumes whose middles are more than 30 minutes apart, before
//           the first middle, or after the last. A site of a mosaic counts within 15 minutes of its
//           volumes, as in the mosaic's frames.
// States    If one of the two volumes has not seen a cell, the cell is as in the other volume (as
//           in time_interpolation.h).
// Limits    A frame does not account for echo that grows, decays or turns between the volumes.
//           Moments other than REF do not move: they are kept or blended in place. If sweeps are
//           undated, the minutes from the lowest to the highest sweep are ignored.
// Memory    Two grids of a station and the new frame; for a mosaic, its partials.
// Threads   One thread at a time. An object starts up to `threads` threads of its own.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "grid/mosaic/time_interpolation.h"
#include "pipeline/keep/geometry_cache.h"
#include "pipeline/mosaic/instant_cache.h"
#include "pipeline/mosaic/mosaic_frame.h"
#include "pipeline/options/domain.h"
#include "stormcellar/base/result.h"
#include "stormcellar/cache/store.h"

namespace stormcellar::pipeline {

struct BetweenOptions {
    grid::TimeMethod method = grid::TimeMethod::advected;
    std::optional<UtcTime> from, to;  // none: as far as there are grids
    int threads = 1;
};

class BetweenGrids {
  public:
    static constexpr std::chrono::minutes longest_bridge{30};

    // Keeps a copy of the store. Leaves out grids that cannot be read, and names them in
    // `problems`. Errors: not_found if there is no grid, or a mosaic's sites have no grids;
    // unsupported for a mosaic whose rules the defaults cannot express; those of the store.
    static Result<BetweenGrids> open(const cache::StoreReader& store, const std::string& domain,
                                     level2::Moment moment, const BetweenOptions& options,
                                     std::vector<std::string>& problems);

    // Returns the instants at which frames can be made. They are whole multiples of the interval
    // since midnight UTC.
    [[nodiscard]] std::vector<UtcTime> instants(std::chrono::seconds interval) const;
    // Makes the frame of an instant. Returns none if no volume is near the instant. Errors: if a
    // grid does not verify, that error, with the grid's path at the start of the message; those of
    // make_frame().
    [[nodiscard]] Result<std::optional<MosaicFrame>> at(UtcTime instant);
    // Returns true if there is a frame of the mosaic at the path, made by the rules of at().
    [[nodiscard]] bool stands(const std::filesystem::path& path) const;
    // Returns the method, such as "advected", with a remark if sweeps are undated.
    [[nodiscard]] std::string method_text() const;

  private:
    struct Stored {
        std::filesystem::path path;
        UtcTime middle;
        grid::GridSpec spec;
        bool dated = false;
    };
    BetweenGrids(const cache::StoreReader& store, level2::Moment moment, BetweenOptions options);
    Status learn_rules(const cache::GridDescription& newest);
    [[nodiscard]] Result<std::optional<MosaicFrame>> of_volumes(UtcTime instant);
    [[nodiscard]] Result<std::optional<MosaicFrame>> of_partials(UtcTime instant);
    [[nodiscard]] std::optional<std::size_t> before(UtcTime instant) const;

    cache::StoreReader store_;
    level2::Moment moment_;
    BetweenOptions options_;
    std::vector<Stored> grids_;     // by their middles; frames of a mosaic by their instants
    std::optional<Domain> mosaic_;  // none: a station's own grids
    std::unique_ptr<GeometryCache> geometries_;
    std::unique_ptr<InstantCache> instants_;
    // The last pair of volumes (index of the earlier one in grids_), and the motion between them.
    std::optional<std::size_t> pair_;
    Motions motions_;
};

}  // namespace stormcellar::pipeline
