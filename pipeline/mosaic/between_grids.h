// pipeline/mosaic/between_grids.h -- frames of a domain for any instant, made of what its cache
// holds.
//
// Where frames are to stand closer than grids do. Two kinds of domains:
//   a station's own    from the volumes before and after the instant, by
//   grid/mosaic/time_interpolation.h:
//                      each cell from its own time, where the grid says when its sweeps were made,
//                      else as one at the volume's middle. At the middle of a volume with undated
//                      sweeps it is that volume's grid, code by code.
//   a mosaic           from its sites' grids (NAME.ICAO), by the chain and the rules that its own
//                      frames are made by (pipeline/mosaic/mosaic_frame.h). At their instants it is
//                      those, code by code.
// Gaps      between volumes whose middles are more than 30 minutes apart nothing is made (a site of
//           a mosaic: within 15 minutes of a volume, the mosaic's own rule). Nothing is made before
//           the first middle or after the last.
// States    as the interpolation has them: what one end has not seen is never blended into clear
//           air, the other end stands.
// Not accounted for: echo that grows, decays or turns between the volumes; motion of moments other
//           than REF, which stand or are blended where they are; with undated sweeps the minutes
//           from the lowest to the highest.
// Memory    two grids of a station and the one that is made; of a mosaic what its partials take.
// Thread contract: one thread; `threads` of its own work for it.
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
    std::optional<UtcTime> from, to;  // none: as far as grids stand
    int threads = 1;
};

class BetweenGrids {
  public:
    static constexpr std::chrono::minutes longest_bridge{30};

    // Keeps a copy of the store. Grids that cannot be read are named in `problems` and left out.
    // Errors: not_found where no grid stands, or a mosaic's sites have none; unsupported for a
    // mosaic that was made by rules other than the defaults can be.
    static Result<BetweenGrids> open(const cache::StoreReader& store, const std::string& domain,
                                     level2::Moment moment, const BetweenOptions& options,
                                     std::vector<std::string>& problems);

    // Whole multiples of the interval since midnight UTC.
    [[nodiscard]] std::vector<UtcTime> instants(std::chrono::seconds interval) const;
    // None where no volume is near. Errors: a grid that does not verify (its path begins the
    // message); those of make_frame().
    [[nodiscard]] Result<std::optional<MosaicFrame>> at(UtcTime instant);
    // Whether a mosaic's own frame that is what at() would give stands at the path.
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
    std::vector<Stored> grids_;     // by their middles; a mosaic's frames by their instants
    std::optional<Domain> mosaic_;  // none: a station's own
    std::unique_ptr<GeometryCache> geometries_;
    std::unique_ptr<InstantCache> instants_;
    // Of the pair of volumes that was used last.
    std::optional<std::size_t> pair_;
    Motions motions_;
};

}  // namespace stormcellar::pipeline
