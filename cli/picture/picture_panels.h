// cli/picture/picture_panels.h -- several moments in one picture: --panels REF,VEL.
//
// Threads   Pure functions but for the files that they read.
// Errors    See each function.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/picture/picture_grid.h"
#include "cli/picture/scene_file.h"
#include "cli/picture/scene_options.h"
#include "render/options/panel_scenes.h"
#include "stormcellar/base/result.h"
#include "stormcellar/cache/store.h"
#include "stormcellar/render/image.h"
#include "stormcellar/render/scene.h"

namespace stormcellar::cli {

using render::PanelScene;

// Returns the panels of a list of moments. Errors: bad_argument for an unknown or repeated moment,
// for a section, for --moment or --colors beside it, and those of scene_with().
[[nodiscard]] Result<std::vector<PanelScene>> panel_scenes(const std::string& list,
                                                           const SceneFile& file,
                                                           const SceneOptions& options);

// Returns the grids of one time in the order of the panels: the newest time, at or before `until`,
// of which the cache has every moment. Returns none, after it was reported, if there is no such
// time. Errors: those of PictureGrid::open().
[[nodiscard]] Result<std::vector<PictureGrid>> stored_panels(const cache::StoreReader& store,
                                                             const std::string& domain,
                                                             const std::vector<PanelScene>& panels,
                                                             std::optional<UtcTime> until);

// Grids the moments of the panels from one decoding of the files, in the order of the panels; of a
// ppi takes the sweep of each moment.
[[nodiscard]] Result<std::vector<PictureGrid>> gridded_panels(
    GridOptions options, const std::vector<PanelScene>& panels);

// Draws the panels. Errors: those of render_panels().
[[nodiscard]] Result<render::Image> draw_panels(const std::string& domain,
                                                const std::vector<PanelScene>& panels,
                                                const std::vector<PictureGrid>& grids,
                                                const SceneOptions& options);

}  // namespace stormcellar::cli
