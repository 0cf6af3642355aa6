// stormcellar frame: draws one still picture, of files or of a grid in the cache.
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "base/name_list.h"
#include "base/steady_time.h"
#include "cli/picture/frame_options.h"
#include "cli/picture/frame_panels.h"
#include "cli/picture/frame_probe.h"
#include "cli/picture/frame_report.h"
#include "cli/picture/frame_sources.h"
#include "cli/picture/look_costs.h"
#include "cli/picture/picture_grid.h"
#include "cli/picture/picture_plan.h"
#include "cli/picture/still_output.h"
#include "cli/shared/commands.h"
#include "grid/frame/named_place.h"
#include "render/options/fitted_view.h"
#include "render/options/still_frame.h"
#include "render/products/rotation.h"
#include "stormcellar/render/still.h"

namespace stormcellar::cli {
namespace {

// Draws the frame. `fit_s` is the time for fitting the view; it is part of the reading time.
Result<FrameTiming> make_frame(const FrameOptions& options, const render::Scene& scene,
                               const PictureGrid& file, const render::Overlays& overlays,
                               SteadyTime start, double fit_s) {
    FrameTiming timing;
    timing.read_s = seconds_since(start);
    timing.decode_s = decode_s(file);
    const auto facts = frame_facts_of(options.domain, file.description(), options.scene.time_zone);
    const int threads = render::thread_count(options.scene);
    render::Scene planned = scene;
    const auto done =
        plan_picture(file.view(), facts, options.plan, options.json, threads, planned);
    if (!done) return pass_on(done);
    if (options.plan.explain) {
        fmt::print(options.json ? stderr : stdout, "{}",
                   look_costs(file.view(), planned, fit_s, threads));
    }
    const render::StillWriting writing{
        .format = still_format(options.output),
        .tiff = options.tiff,
        .error = *done,
        .threads = threads,
        .drawn = [&] { timing.render_s = seconds_since(start) - timing.read_s; }};
    const grid::BrickView view = file.view();
    const auto bytes = render::encode_still(
        {options.domain, view, file.description(), options.scene, true, overlays}, planned,
        writing);
    if (!bytes) return pass_on(bytes);
    if (Status whole = file.check_whole(); !whole) return pass_on(whole);
    if (auto written = write_still(options.output, *bytes); !written) return pass_on(written);
    timing.total_s = seconds_since(start);
    timing.write_s = timing.total_s - timing.read_s - timing.render_s;
    return timing;
}

// Returns the columns of rotation; none if there is no grid of shear. Errors: bad_argument if the
// grid of shear has other cells than the shown grid.
Result<std::optional<grid::BrickGrid>> columns_of(const FrameGrids& grids) {
    std::optional<grid::BrickGrid> columns;
    if (!grids.shear) return columns;
    if (!(*grids.shear->view().spec == *grids.shown->view().spec))
        return fail(ErrorCode::bad_argument, "--rotation: the grid of AZSH has other cells");
    columns = render::rotation_columns(grids.shear->view());
    if (Status whole = grids.shear->check_whole(); !whole) return pass_on(whole);
    return columns;
}

int run_frame(FrameOptions options) {
    const auto start = steady_now();
    if (options.scene_file.error) return report_error(*options.scene_file.error);
    if (const Status fine = check_frame_options(options); !fine) return report_error(fine.error());
    take_panels(options);
    if (!options.panels.empty()) return run_panels(options, start);
    auto scene = scene_with(options.scene_file, options.scene);
    if (!scene) return report_error(scene.error());
    if (const Status fine = check_frame_output(options, scene->product); !fine)
        return report_error(fine.error());
    auto plan = plan_beside_slices(options.plan, options.scene);
    if (!plan) return report_error(plan.error());
    options.plan = std::move(*plan);
    const auto grids = grid_of_frame(options, *scene);
    if (!grids) return report_error(grids.error());
    if (!grids->shown) return exit_nothing_matched;
    const PictureGrid* const grid = &*grids->shown;
    const auto before_fit = steady_now();
    const grid::BrickView view = grid->view();
    const render::StillSource source{options.domain, view, grid->description(), options.scene};
    if (const Status fitted = render::fit_to_grid(source, *scene); !fitted)
        return report_error(fitted.error());
    const double fit_s = render::fits_anything(options.scene) ? seconds_since(before_fit) : 0;
    const auto probe = probe_grid(options, *scene, *grid);
    if (!probe) return report_error(probe.error());
    if (const Status whole = grid->check_whole(); !whole) return report_error(whole.error());
    const auto columns = columns_of(*grids);
    if (!columns) return report_error(columns.error());
    FrameTiming timing{.read_s = seconds_since(start),
                       .decode_s = decode_s(*grid),
                       .total_s = seconds_since(start)};
    if (!options.output.empty()) {
        const grid::BrickView rotation = *columns ? (*columns)->view() : grid::BrickView{};
        const auto shapes = render::read_shapes(options.scene);
        if (!shapes) return report_error(shapes.error());
        const render::Overlays overlays{.rotation = *columns ? &rotation : nullptr,
                                        .cells = grids->cells ? &*grids->cells : nullptr,
                                        .shapes = *shapes ? &**shapes : nullptr};
        const auto drawn = make_frame(options, *scene, *grid, overlays, start, fit_s);
        if (!drawn) return report_error(drawn.error());
        timing = *drawn;
    }
    report_frame(options, *scene, grid->description(), timing, *probe);
    return exit_done;
}

}  // namespace

Run set_up_frame(CLI::App& frame) {
    const auto options = std::make_shared<FrameOptions>();
    add_scene_file(frame, options->scene_file, options->scene, options->plan, nullptr);
    frame
        .add_option("FILE", options->sources,
                    "Level II files to draw, or a domain of the cache. Several files give a mosaic "
                    "of their sites. Tar and zip archives, directories and - for standard input "
                    "work too. A word with a slash, or one that names a file, is a file; every "
                    "other word is a domain")
        ->option_text("FILE...|DOMAIN");
    frame.add_option("--domain", options->domain,
                     "Domain of the cache; a station's own domain is its ICAO identifier. Default: "
                     "the only one");
    add_place(frame, options->cache);
    frame.add_option("--catalog", options->catalog.directory,
                     "Directory of the catalog (state/catalog), which says where the raw file of a "
                     "ppi of a domain is. Default: that of the service");
    frame.add_option("--time", options->time,
                     "Draw a domain's newest grid at or before this time, in UTC or relative as "
                     "-1h. Default: the latest grid. With files, it is the time of the grid, as "
                     "for stormcellar grid");
    frame.add_option("--hours", options->hours,
                     "Length of a rain-total in hours, such as 1, 3 or 24. The total ends at "
                     "--time, or else with the newest volume; minutes without volumes are counted "
                     "as not seen. Default: from the first to the last file. A domain needs it");
    frame.add_option("-o,--output", options->output,
                     still_help() + ". It may be left out with --probe and --probe-at");
    frame.add_option(
        "--geotiff", options->geotiff,
        fmt::format("What a GeoTIFF holds: {}. values are those of the product, states "
                    "say why a place has none, colors are those of the color table. "
                    "Default: {}",
                    names_in(render::tiff_contents, ", ", " or "), render::tiff_contents[0].name));
    frame.add_option(
        "--panels", options->panels,
        "Show several moments of one time side by side, each with its own colors, as in "
        "REF,VEL,RHO,ZDR");
    frame.add_flag("--rotation", options->rotation,
                   fmt::format("Draw columns of rotation in a volume: azimuthal shear of {:g}/s "
                               "or more, {:g} km deep or more",
                               render::least_rotation / 1000, render::least_column_m / 1000));
    frame.add_option(
        "--probe", options->probe,
        "Print the value at this pixel of the picture: X,Y, counted from 0,0 at the top left");
    frame.add_option(
        "--probe-at", options->probe_at,
        fmt::format("Print the value at this place (maps and volumes): {}", grid::place_for_help));
    frame.add_flag("--json", options->json, "Print what was done as one JSON document");
    add_scene_options(frame, options->scene);
    add_picture_plan_options(frame, options->plan);
    add_picture_grid_options(frame, options->grid);
    return [options] { return run_frame(*options); };
}

}  // namespace stormcellar::cli
