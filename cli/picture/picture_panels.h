// cli/picture/picture_panels.h -- `--panels REF,VEL`: draws several moments in one picture.
//
// Threads   Pure functions, except that they read files.
// Errors    See each function.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/picture/picture_grid.h"
#include "cli/picture/scene_arguments.h"
#include "cli/picture/scene_file.h"
#include "render/options/panel_scenes.h"
#include "stormcellar/base/result.h"
#include "stormcellar/cache/store.h"
#include "stormcellar/render/image.h"
#include "stormcellar/render/scene.h"

namespace stormcellar::cli {

using render::PanelScene;

// Returns the panels for a list of moments. Errors: bad_argument for an unknown or repeated moment,
// for a product that is a section, and if --moment or --colors is also given; those of
// scene_with().
[[nodiscard]] Result<std::vector<PanelScene>> panel_scenes(const std::string& list,
                                                           const SceneFile& file,
                                                           const SceneOptions& options);

// Returns the grids of one time in the order of the panels. Takes the newest time, at or before
// `until`, at which the cache has every moment. If there is none, reports that and returns none.
// Errors: those of PictureGrid::open().
[[nodiscard]] Result<std::vector<PictureGrid>> stored_panels(const cache::StoreReader& store,
                                                             const std::string& domain,
                                                             const std::vector<PanelScene>& panels,
                                                             std::optional<UtcTime> until);

// Decodes the files once and makes the grids of the panels' moments, in their order. For a ppi,
// takes the sweep of each moment instead.
[[nodiscard]] Result<std::vector<PictureGrid>> gridded_panels(
    GridOptions options, const std::vector<PanelScene>& panels);

// Draws the panels. Errors: those of render_panels().
[[nodiscard]] Result<render::Image> draw_panels(const std::string& domain,
                                                const std::vector<PanelScene>& panels,
                                                const std::vector<PictureGrid>& grids,
                                                const SceneOptions& options);

}  // namespace stormcellar::cli
