#include "render/map/panel_layout.h"

#include <algorithm>
#include <cmath>

#include "render/map/legend_layout.h"
#include "render/map/picture_space.h"

namespace stormcellar::render {
namespace {

// Panels that are a little wider than tall look best.
constexpr double best_aspect = 1.1;
constexpr int least_panel_width = 180;
constexpr int least_panel_height = 150;
// Lengths for a panel, in pixels at scale 1.
constexpr double title_height = 20;
constexpr double legend_height = 50;
constexpr double gap = 8;
// The scale of lines and letters in a panel, as a share of the scale of the whole picture.
constexpr double panel_scale = 0.62;

struct Grid {
    int columns = 1, rows = 1;
    // The place of the first panel, the size of each panel in whole pixels, and the gap between two
    // panels.
    double left = 0, top = 0, width = 0, height = 0, between = 0;

    [[nodiscard]] Rect cell(int index) const {
        const double x = left + index % columns * (width + between);
        const double y = top + index / columns * height;
        return {std::round(x), std::round(y), width, height};
    }
};

Grid grid_of(int count, int width, int height, const PictureSpace& space, double between) {
    Grid grid;
    const double inner = height - space.header - space.footer;
    grid.columns = panels_in_a_row(count, width, static_cast<int>(inner));
    grid.rows = (count + grid.columns - 1) / grid.columns;
    grid.top = space.header;
    grid.width = std::floor((width - (grid.columns - 1) * between) / grid.columns);
    grid.between = between;
    grid.height = std::floor(inner / grid.rows);
    return grid;
}

}  // namespace

int panels_in_a_row(int count, int width, int height) {
    int best = 1;
    double least = HUGE_VAL;
    for (int columns = 1; columns <= count; ++columns) {
        const int rows = (count + columns - 1) / columns;
        const double aspect = static_cast<double>(width) / columns / height * rows;
        // Each empty place makes an arrangement worse.
        const double empty = static_cast<double>(rows * columns - count) / count;
        const double worth = std::abs(std::log(aspect / best_aspect)) + empty;
        if (worth >= least) continue;
        best = columns;
        least = worth;
    }
    return best;
}

Result<PanelLayout> lay_out_panels(const Fonts& fonts, const Scene& scene, const FrameFacts& facts,
                                   const DrawnFacts& picture, std::span<const Legend> legends) {
    const PictureSpace space = space_of(scene.width, scene.height);
    const auto count = static_cast<int>(legends.size());
    const double scale = std::max(least_text_scale, panel_scale * space.scale);
    const Grid grid =
        grid_of(count, scene.width, scene.height, space, count > 1 ? std::round(gap * scale) : 0);
    if (grid.width < least_panel_width || grid.height < least_panel_height) {
        return fail(
            ErrorCode::bad_argument,
            "{} panels need a larger picture than {} by {} pixels: each is {:.0f} by {:.0f}, "
            "and needs {} by {}",
            count, scene.width, scene.height, grid.width, grid.height, least_panel_width,
            least_panel_height);
    }
    PanelLayout layout;
    layout.scale = scale;
    layout.labels.scale = layout.scale;
    layout.labels.shades = &shades_of(scene.theme);
    LabelBuilder whole(fonts, *layout.labels.shades, space.scale, layout.labels);
    lay_out_header(whole, space.shape, scene.width, header_of(facts, picture.legend.product));
    lay_out_footer(whole, scene.width, scene.height, footer_of(scene, facts, picture));
    LabelBuilder part(fonts, *layout.labels.shades, layout.scale, layout.labels);
    const double title = std::round(part.scaled(title_height));
    const double legend = std::round(part.scaled(legend_height));
    for (int i = 0; i < count; ++i) {
        const Rect cell = grid.cell(i);
        const Rect shown = {cell.x, cell.y + title, cell.width, cell.height - title - legend};
        const double room = part.scaled(10);
        const Rect band = {shown.x + room, shown.bottom() - part.scaled(2), shown.width - 2 * room,
                           legend};
        part.put(legends[static_cast<std::size_t>(i)].product, band.x, cell.y + part.scaled(14),
                 band.width, part.strong(11));
        lay_out_band(part, legends[static_cast<std::size_t>(i)], band);
        layout.pictures.push_back(shown);
    }
    return layout;
}

}  // namespace stormcellar::render
