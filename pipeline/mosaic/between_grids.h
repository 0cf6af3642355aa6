// pipeline/mosaic/between_grids.h -- makes frames of a domain for any instant from the grids in its
// cache.
//
// It is for frames that are closer in time than the grids. There are two kinds of domains:
//   a station's own    from the volumes before and after the instant, by
//                      grid/mosaic/time_interpolation.h: each cell from its own time if the grid
//                      says when its sweeps were made, otherwise all cells from the volume's
//                      middle. At the middle of a volume with undated sweeps the frame is that
//                      volume's grid, code by code.
//   a mosaic           from the grids of its sites (NAME.ICAO), by the chain and the rules of its
//   own
//                      frames (pipeline/mosaic/mosaic_frame.h). At the instants of these the result
//                      is the same frame, code by code.
// Gaps      No frame is made between volumes whose middles are more than 30 minutes apart (a mosaic
//           uses a site within 15 minutes of a volume, the mosaic's own rule), nor before the first
//           middle or after the last.
// States    As the interpolation has them: a cell that one end has not seen is never blended into
//           clear air; the other end's value is used.
// Not accounted for: echo that grows, decays or turns between the volumes; motion of moments other
//           than REF, which stay or are blended where they are; with undated sweeps the minutes
//           from the lowest sweep to the highest.
// Memory    Two grids of a station and the frame; for a mosaic, what its partials take.
// Thread contract: one thread; up to `threads` threads work for it.
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

    // Copies the store. Grids that cannot be read are named in `problems` and left out. Errors:
    // not_found if there is no grid, or the sites of a mosaic have none; unsupported for a mosaic
    // that was made by rules that differ from the defaults.
    static Result<BetweenGrids> open(const cache::StoreReader& store, const std::string& domain,
                                     level2::Moment moment, const BetweenOptions& options,
                                     std::vector<std::string>& problems);

    // Whole multiples of the interval since midnight UTC.
    [[nodiscard]] std::vector<UtcTime> instants(std::chrono::seconds interval) const;
    // None if no volume is near. Errors: a grid that does not verify (its path begins the message);
    // those of make_frame().
    [[nodiscard]] Result<std::optional<MosaicFrame>> at(UtcTime instant);
    // Returns true if the file at the path is a mosaic's own frame equal to what at() would make.
    [[nodiscard]] bool stands(const std::filesystem::path& path) const;
    // "advected", and what of it is not known.
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
    std::optional<Domain> mosaic_;  // none: a station's own domain
    std::unique_ptr<GeometryCache> geometries_;
    std::unique_ptr<InstantCache> instants_;
    // For the pair of volumes that was used last.
    std::optional<std::size_t> pair_;
    Motions motions_;
};

}  // namespace stormcellar::pipeline
