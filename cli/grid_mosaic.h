// cli/grid_mosaic.h -- `stormcellar grid A B C...`: files of several sites, or of several times,
// become one grid for an instant (pipeline/mosaic_frame.h).
#pragma once

#include <optional>
#include <string>

#include "base/result.h"
#include "cli/effect_options.h"
#include "cli/grid_request.h"
#include "grid/grid.h"
#include "pipeline/mosaic_frame.h"

namespace stormcellar::cli {

// As they were typed.
struct MosaicOptions {
    std::string overlap;
    std::optional<double> overlap_km;
    std::string time_method;
};
void add_mosaic_options(CLI::App& app, MosaicOptions& options);

struct MosaicRequest {
    grid::MosaicOptions overlap;
    grid::TimeMethod time = grid::TimeMethod::advected;
};
// Errors: bad_argument, naming the option: also for one that only several files have a use for.
[[nodiscard]] Result<MosaicRequest> parse_mosaic(const MosaicOptions& options, std::size_t files,
                                                 const GridRequest& request,
                                                 const EffectRequest& effects);

struct MosaicTimings {
    double read_s = 0, decode_s = 0, grid_s = 0, merge_s = 0;
};

// How many geometries of sites are kept at once.
inline constexpr std::size_t mosaic_geometries = 4;

// What the files show, each on its site's window of one grid.
struct MosaicParts {
    grid::GridSpec spec;
    std::vector<grid::SitePosition> sites;
    std::vector<pipeline::MadePartial> partials;
    UtcTime instant;  // what it is made for
    MosaicTimings timings;

    [[nodiscard]] std::vector<pipeline::PartialView> views() const;  // valid while this lives
};
// Grid and instant as make_mosaic() has them. Errors: those of reading, decoding and gridding;
// bad_argument for a site that sees nothing of the grid.
[[nodiscard]] Result<MosaicParts> make_parts(const std::vector<std::string>& files,
                                             const GridRequest& request,
                                             const EffectRequest& effects,
                                             pipeline::GeometryCache& geometries);

struct MadeMosaic {
    grid::Grid grid;
    MosaicTimings timings;
};

// Without --center the middle of the sites, without an extent 230 km beyond them; without --time
// the middle of what the newest volumes of all sites show, however far they are apart.
[[nodiscard]] Result<MadeMosaic> make_mosaic(const std::vector<std::string>& files,
                                             const GridRequest& request,
                                             const MosaicRequest& mosaic,
                                             const EffectRequest& effects);

}  // namespace stormcellar::cli
