// cli/grid/grid_mosaic.h -- `stormcellar grid A B C...`: grids files of several sites, or of
// several times, as one grid for an instant (pipeline/mosaic/mosaic_frame.h).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/grid/grid_request.h"
#include "cli/grid/volume_source.h"
#include "cli/shared/effect_options.h"
#include "pipeline/mosaic/mosaic_scene.h"
#include "pipeline/plan/mosaic_of_volumes.h"
#include "stormcellar/base/result.h"
#include "stormcellar/grid/grid_spec.h"

namespace stormcellar::cli {

// The options as they were typed.
struct MosaicOptions {
    std::string overlap;
    std::optional<double> overlap_km;
};
void add_mosaic_options(CLI::App& app, MosaicOptions& options, EffectOptions& effects);

// Parses the options for one moment. Averaging keeps its default here, because --effect sets it.
// Errors: bad_argument, naming the option; also for an option that needs several files if there is
// only one file.
[[nodiscard]] Result<grid::MosaicOptions> parse_mosaic(const MosaicOptions& options,
                                                       const EffectOptions& effects,
                                                       std::size_t files,
                                                       const GridRequest& request,
                                                       level2::Moment moment);

// Returns a grid about the requested center, or else about the middle of the sites. Without a
// requested extent, the grid reaches 230 km beyond the sites. Errors: those of spec_about().
[[nodiscard]] Result<grid::GridSpec> mosaic_spec(const std::vector<grid::SitePosition>& sites,
                                                 GridRequest request);

// The volumes of a mosaic, and the spec of its grid.
struct MosaicSources {
    std::vector<SourceVolume> volumes;
    std::vector<std::string> files;  // one for each volume
    grid::GridSpec spec;
    double read_s = 0, decode_s = 0;

    [[nodiscard]] std::vector<pipeline::SceneVolume> scene_volumes() const;
    // Returns the volumes that hold the moment. If none does, returns all volumes.
    [[nodiscard]] std::vector<pipeline::SceneVolume> scene_volumes(level2::Moment moment) const;
    [[nodiscard]] std::size_t site_count() const;
};
[[nodiscard]] Result<MosaicSources> load_mosaic(const std::vector<std::string>& files,
                                                const GridRequest& request);

// Returns the request for `overlap.moment`, on the grid of the sources. Without --time the request
// has no instant, and the mosaic chooses one: it takes the middle time of each site's newest
// volume, and the instant is half way between the earliest and the latest of these times. If they
// are more than 30 minutes apart, the instant is the latest.
[[nodiscard]] pipeline::MosaicRequest mosaic_request(const MosaicSources& sources,
                                                     const GridRequest& request,
                                                     const grid::MosaicOptions& overlap,
                                                     const EffectRequest& effects);

}  // namespace stormcellar::cli
