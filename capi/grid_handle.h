// capi/grid_handle.h -- the object behind stormcellar_grid, and the steps from a volume to a grid.
//
// Threads   Plain data, which never changes after the object is made; functions without state.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "capi/volume_handle.h"
#include "stormcellar.h"
#include "stormcellar/accuracy/chain.h"
#include "stormcellar/base/result.h"
#include "stormcellar/grid/grid.h"
#include "stormcellar/grid/gridder.h"
#include "stormcellar/grid/mosaic.h"

struct stormcellar_grid {
    stormcellar::grid::Grid grid;
    bool is_mean_of_cells = false;
    std::string domain = {};  // of the cache; empty: the grid is not from a cache
};

namespace stormcellar::capi {

// Errors: not_found if the position of the radar is unknown.
[[nodiscard]] Result<grid::SitePosition> site_of(const stormcellar_volume& volume);

// Returns the grid spec that the options ask for, about their center. Without a center, the grid is
// about the sites: about one site as `stormcellar grid` makes it, else 230 km beyond the outermost
// sites. Errors: bad_argument.
[[nodiscard]] Result<grid::GridSpec> spec_of(const stormcellar_grid_options& options,
                                             const std::vector<grid::SitePosition>& sites);

// Returns the moment and the threads. Errors: bad_argument.
[[nodiscard]] Result<grid::GridderOptions> gridder_of(const stormcellar_grid_options& options);

// The cells, the moment and the threads of a grid of one volume, and the place of its radar.
struct VolumeGridding {
    grid::SitePosition site;
    grid::GridSpec spec;
    grid::GridderOptions gridder;
};

// Reads the options for a grid of one volume. Errors: those of site_of(), spec_of() and
// gridder_of().
[[nodiscard]] Result<VolumeGridding> gridding_of(const stormcellar_grid_options& options,
                                                 const stormcellar_volume& volume);

// Returns the steps of gridding, or of a mosaic with this overlap, with the settings that the
// options name. Errors: bad_argument.
[[nodiscard]] Result<accuracy::Chain> chain_of(const stormcellar_grid_options& options,
                                               level2::Moment moment,
                                               std::optional<grid::Overlap> overlap);

// Grids the volume by the default choice of the chain, and says in the provenance how and from
// what. Errors: those of make_grid().
[[nodiscard]] Result<grid::Grid> grid_of(const stormcellar_volume& volume,
                                         const grid::SitePosition& site, const grid::GridSpec& spec,
                                         const accuracy::Chain& chain,
                                         grid::GridderOptions gridder);

}  // namespace stormcellar::capi
