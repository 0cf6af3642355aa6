// web/data/pictures/frame_style.h -- reads the query of a picture, and draws the picture.
//
// Threads   Functions without state; drawing uses `threads` threads of its own.
// Errors    See each function.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "render/options/panel_scenes.h"
#include "render/options/scene_options.h"
#include "stormcellar/base/result.h"
#include "stormcellar/cache/grid_file.h"
#include "stormcellar/grid/brick_view.h"
#include "stormcellar/render/overlays.h"
#include "stormcellar/render/still.h"
#include "web/data/grids/kept_answers.h"
#include "web/http/request.h"

namespace stormcellar::web {

// Limits; larger pictures would delay all other pictures.
inline constexpr std::int64_t most_frame_pixels = 3840 * 2160;
inline constexpr std::int64_t most_frame_samples = most_frame_pixels * 256;  // pixels times slices

// The picture that a query asks for. It does not say which grid is shown.
struct FrameStyle {
    render::SceneOptions options;
    std::vector<render::PanelScene> panels;  // one, or several in one picture
    bool has_panels = false;                 // the query has "panels", even with one name
    const render::StillFormat* format = nullptr;
    render::TiffContent tiff = render::TiffContent::values;
    int hours = 0;                                          // of a rain total; 0: another product
    std::shared_ptr<const render::CellOverlay> cells = {};  // to mark; their grids are in `key`
    std::string key;  // the whole style as one text, to tell styles apart
};

// Reads the query of a picture. The ending of the file's name gives the format. The parameters are
// the options of `stormcellar frame` (web/data/pictures/picture_query.h), "panels", "geotiff" and
// "hours".
// Ignores parameters named in `others`, which the caller reads. Errors: not_found for an ending
// that no format has; bad_argument.
[[nodiscard]] Result<FrameStyle> frame_style(std::string_view file_name, const Fields& query,
                                             std::span<const std::string_view> others);

// The grid that a panel of a picture shows. Its cells and description must outlive the panel.
struct DrawnPanel {
    grid::BrickView view;
    const cache::GridDescription* description;
};

// Draws the panels of the style as `stormcellar frame` does. The notes of the result are the media
// type. Errors: those of drawing.
[[nodiscard]] Result<Kept> draw_frame(const std::string& domain, const FrameStyle& style,
                                      std::span<const DrawnPanel> panels, std::string etag,
                                      int threads);

}  // namespace stormcellar::web
