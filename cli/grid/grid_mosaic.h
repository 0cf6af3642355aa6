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
#include "pipeline/plan/mosaic_plan.h"
#include "stormcellar/base/result.h"
#include "stormcellar/grid/grid.h"

namespace stormcellar::cli {

// The options as they were typed.
struct MosaicOptions {
    std::string overlap;
    std::optional<double> overlap_km;
};
void add_mosaic_options(CLI::App& app, MosaicOptions& options, EffectOptions& effects);

// Errors: bad_argument, naming the option, also for an option that only makes sense with several
// files. The averaging is the default one, because it is among the effects.
[[nodiscard]] Result<grid::MosaicOptions> parse_mosaic(const MosaicOptions& options,
                                                       const EffectOptions& effects,
                                                       std::size_t files,
                                                       const GridRequest& request);

// Returns a grid about the requested center, else about the middle of the sites; without an extent,
// up to 230 km beyond them. Errors: those of spec_about().
[[nodiscard]] Result<grid::GridSpec> mosaic_spec(const std::vector<grid::SitePosition>& sites,
                                                 GridRequest request);

struct MosaicTimings {
    double read_s = 0, decode_s = 0, plan_s = 0, grid_s = 0, merge_s = 0;
};

// This many geometries of sites are kept at a time.
inline constexpr std::size_t mosaic_geometries = 4;

// The volumes of a mosaic, and the grid that holds them.
struct MosaicSources {
    std::vector<SourceVolume> volumes;
    std::vector<std::string> files;  // one for each volume
    grid::GridSpec spec;
    MosaicTimings timings;

    [[nodiscard]] std::vector<pipeline::SceneVolume> scene_volumes() const;
    [[nodiscard]] std::size_t site_count() const;
};
[[nodiscard]] Result<MosaicSources> load_mosaic(const std::vector<std::string>& files,
                                                const GridRequest& request);

// Returns one partial for each volume, gridded by the default as changed by the settings of the
// effects. Errors name the file: those of gridding; bad_argument for a site that sees nothing of
// the grid.
[[nodiscard]] Result<std::vector<pipeline::MadePartial>> grid_sources(
    const MosaicSources& sources, const GridRequest& request, const EffectRequest& effects,
    pipeline::GeometryCache& geometries);

// Returns the scene on which the accuracy planner measures. The sources must outlive it.
[[nodiscard]] Result<pipeline::MosaicScene> mosaic_scene(const MosaicSources& sources,
                                                         const GridRequest& request,
                                                         const grid::MosaicOptions& overlap,
                                                         const EffectRequest& effects);

struct MadeMosaic {
    grid::Grid grid;                     // empty if the plan does not meet its budget
    std::optional<accuracy::Plan> plan;  // if one was requested
    MosaicTimings timings;
};

// Without --center the middle of the sites is used, without an extent 230 km beyond them. Without
// --time it is the middle of what the newest volumes of all sites cover, or the newest of them if
// they are more than 15 minutes from that middle; notes name the volumes that are then left out.
[[nodiscard]] Result<MadeMosaic> make_mosaic(const std::vector<std::string>& files,
                                             const GridRequest& request,
                                             const grid::MosaicOptions& overlap,
                                             const EffectRequest& effects);

}  // namespace stormcellar::cli
