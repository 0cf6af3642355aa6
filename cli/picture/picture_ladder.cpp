#include "cli/picture/picture_ladder.h"

#include <algorithm>

#include "render/color/built_in_tables.h"
#include "render/plan/volume_plan.h"
#include "render/view/fitted_camera.h"
#include "stormcellar/grid/brick_grid.h"
#include "stormcellar/grid/column_geometry.h"
#include "stormcellar/grid/gridder.h"
#include "stormcellar/render/render.h"

namespace stormcellar::cli {
namespace {

Result<grid::BrickGrid> bricks_for(const SourceVolume& source, const GridRequest& request,
                                   const grid::GridSpec& spec) {
    const auto columns = grid::make_column_geometry(source.site, spec);
    if (!columns) return pass_on(columns);
    grid::GridderOptions options;
    options.moment = request.moment;
    options.threads = request.threads;
    const auto grid = grid::make_grid(source.volume, source.site, **columns, options);
    if (!grid) return pass_on(grid);
    return grid::BrickGrid::from(*grid, grid::default_quantization(request.moment));
}

// Measures the ladder of a picture without light, and then the steps of the light for a picture
// with all kinds of light. The picture has the default colors and view of `frame`.
Result<std::vector<accuracy::LadderRow>> run_both(const grid::BrickView& view,
                                                  const GridRequest& request) {
    render::Scene scene;
    scene.moment = request.moment;
    const render::EchoOutline outline(view, request.moment);
    scene.colors = render::is_clear_air(outline) ? render::clear_air_colors()
                                                 : render::smooth_color_table(request.moment);
    render::apply(render::fit_view(outline, scene, scene.width, scene.height), scene);
    render::VolumeScene drawn(view, render::colors_of(scene), scene, scene.width, scene.height,
                              request.threads);
    auto rows = render::run_ladder(drawn, render::volume_chain());
    if (!rows) return pass_on(rows);
    const auto lit = render::run_ladder(drawn, render::volume_chain({true, true, true}));
    if (!lit) return pass_on(lit);
    for (const accuracy::LadderRow& row : *lit) {
        if (row.step == "surface" || row.step == "light") rows->push_back(row);
    }
    return rows;
}

}  // namespace

Result<std::vector<accuracy::LadderRow>> ladder_of_picture(
    const SourceVolume& source, const GridRequest& request, const grid::GridSpec& spec, int rounds,
    const std::function<void(std::size_t, std::size_t)>& progress) {
    const auto bricks = bricks_for(source, request, spec);
    if (!bricks) return pass_on(bricks);
    const grid::BrickView view = bricks->view();
    const bool any_value = std::any_of(view.bricks.begin(), view.bricks.end(),
                                       [](const auto& brick) { return brick.value_count > 0; });
    if (!any_value)
        return fail(ErrorCode::not_found, "there is nothing to draw: no cell has a value");
    const auto total = static_cast<std::size_t>(std::max(1, rounds));
    progress(0, total);
    auto rows = run_both(view, request);
    for (int round = 1; rows && round < rounds; ++round) {
        progress(static_cast<std::size_t>(round), total);
        const auto again = run_both(view, request);
        if (!again) return pass_on(again);
        for (std::size_t i = 0; i < rows->size(); ++i)
            (*rows)[i].time_s = std::min((*rows)[i].time_s, (*again)[i].time_s);
    }
    if (rows) accuracy::mark_pareto(*rows);
    return rows;
}

}  // namespace stormcellar::cli
