// cli/grid/grid_mosaic.h -- `stormcellar grid A B C...`: files of several sites, or of several
// times, become one grid for an instant (pipeline/mosaic/mosaic_frame.h).
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

// For one moment. Errors: bad_argument, naming the option, also for an option that only makes sense
// with several files. The averaging is the default one, because it is among the effects.
[[nodiscard]] Result<grid::MosaicOptions> parse_mosaic(const MosaicOptions& options,
                                                       const EffectOptions& effects,
                                                       std::size_t files,
                                                       const GridRequest& request,
                                                       level2::Moment moment);

// Returns a grid about the requested center, else about the middle of the sites; without an extent,
// up to 230 km beyond them. Errors: those of spec_about().
[[nodiscard]] Result<grid::GridSpec> mosaic_spec(const std::vector<grid::SitePosition>& sites,
                                                 GridRequest request);

// The volumes of a mosaic, and the grid that holds them.
struct MosaicSources {
    std::vector<SourceVolume> volumes;
    std::vector<std::string> files;  // one for each volume
    grid::GridSpec spec;
    double read_s = 0, decode_s = 0;

    [[nodiscard]] std::vector<pipeline::SceneVolume> scene_volumes() const;
    // Those of the volumes that hold the moment; all, if none does.
    [[nodiscard]] std::vector<pipeline::SceneVolume> scene_volumes(level2::Moment moment) const;
    [[nodiscard]] std::size_t site_count() const;
};
[[nodiscard]] Result<MosaicSources> load_mosaic(const std::vector<std::string>& files,
                                                const GridRequest& request);

// What the options ask for, of the moment that `overlap` is for. Without --center the grid lies
// about the middle of the sites, without an extent it reaches 230 km beyond them; without --time it
// is for the middle of what the newest volumes of all sites show, or of the newest of them where
// they lie more than 15 minutes from that.
[[nodiscard]] pipeline::MosaicRequest mosaic_request(const MosaicSources& sources,
                                                     const GridRequest& request,
                                                     const grid::MosaicOptions& overlap,
                                                     const EffectRequest& effects);

}  // namespace stormcellar::cli
