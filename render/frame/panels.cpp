#include "stormcellar/render/panels.h"

#include <fmt/format.h>

#include "render/frame/view_picture.h"
#include "render/map/map_lines.h"
#include "render/map/panel_layout.h"
#include "stormcellar/grid/sweep_lookup.h"
#include "stormcellar/render/product.h"
#include "stormcellar/render/render.h"

namespace stormcellar::render {
namespace {

Status check_panels(std::span<const Panel> panels) {
    if (panels.empty() || panels.size() > most_panels) {
        return fail(ErrorCode::bad_argument, "a picture has 1 to {} panels, not {}", most_panels,
                    panels.size());
    }
    for (const Panel& panel : panels) {
        if (view_of(panel.scene.product) == View::section) {
            return fail(ErrorCode::bad_argument, "panels show volumes and maps, not sections");
        }
        if (auto valid = check_frame(panel.view, panel.facts, panel.scene); !valid) return valid;
    }
    return {};
}

// Returns the facts for the labels of the whole picture. They are the facts of the first panel, but
// the product names the moments of all panels.
DrawnFacts facts_of_whole(std::span<const Panel> panels,
                          const std::vector<ColumnSummary>& columns) {
    const Panel& first = panels.front();
    const grid::SweepLookup* const sweep = first.view.sweep;
    DrawnFacts facts{legend_of(first.scene), drawn_ring_spacing(*first.view.spec, first.scene),
                     std::nullopt};
    if (sweep == nullptr) facts.coverage = coverage_of(columns, *first.view.spec);
    facts.legend.product.clear();
    for (const Panel& panel : panels) {
        if (!facts.legend.product.empty()) facts.legend.product += ", ";
        facts.legend.product += level2::moment_name(panel.scene.moment);
    }
    if (sweep != nullptr) {
        facts.legend.product +=
            fmt::format(" at {:.1f} degrees elevation (PPI)", sweep->facts().fixed_angle_deg);
    }
    return facts;
}

// Returns the summaries of a grid's columns. For a sweep, which has no columns, returns nothing.
std::vector<ColumnSummary> columns_of(const grid::BrickView& view, int threads) {
    return view.sweep != nullptr ? std::vector<ColumnSummary>{} : summarize_columns(view, threads);
}

}  // namespace

Result<Image> render_panels(std::span<const Panel> panels, int threads, FrameCache* kept) {
    if (auto valid = check_panels(panels); !valid) return pass_on(valid);
    const Scene& scene = panels.front().scene;
    const auto fonts = Fonts::load();
    if (!fonts) return pass_on(fonts);
    // Keep these scenes until the end, because legends point at their colors.
    std::vector<Scene> shown;
    for (const Panel& panel : panels)
        shown.push_back(scene_shown(panel.view, panel.scene));
    std::vector<Legend> legends;
    for (const Scene& one : shown)
        legends.push_back(legend_of(one));
    auto columns = columns_of(panels.front().view, threads);
    const auto layout = lay_out_panels(*fonts, scene, panels.front().facts,
                                       facts_of_whole(panels, columns), legends);
    if (!layout) return pass_on(layout);
    Canvas canvas(scene.width, scene.height, layout->labels.shades->page);
    FrameCache own;
    FrameCache& cache = kept != nullptr ? *kept : own;
    for (std::size_t i = 0; i < panels.size(); ++i) {
        const Panel& panel = panels[i];
        if (i > 0) columns = columns_of(panel.view, threads);
        const Rect& place = layout->pictures[i];
        const PictureSize size{static_cast<int>(place.width), static_cast<int>(place.height),
                               layout->scale};
        const auto picture = draw_view({panel.view, panel.facts, panel.scene, columns}, size,
                                       scene.labels ? &*fonts : nullptr, threads, cache);
        if (!picture) return picture;
        canvas.place(*picture, static_cast<int>(place.x), static_cast<int>(place.y));
    }
    draw_labels(canvas, *fonts, layout->labels);
    return canvas.image();
}

}  // namespace stormcellar::render
