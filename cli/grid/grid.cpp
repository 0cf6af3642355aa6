// stormcellar grid FILE... -o OUT.nc: decodes volumes, grids them, and writes the grid as netCDF or
// in another format.
#include <algorithm>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "accuracy/explain.h"
#include "base/steady_time.h"
#include "cli/grid/grid_files.h"
#include "cli/grid/grid_notes.h"
#include "cli/grid/grid_report.h"
#include "cli/grid/grid_request.h"
#include "cli/grid/surface_options.h"
#include "cli/shared/commands.h"
#include "cli/shared/output_file.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/export/grid_format.h"

namespace stormcellar::cli {
namespace {

// Drops the '/' that shells add to the name of a directory.
std::string without_slash(const std::string& output) {
    std::string name = output.substr(0, output.find_last_not_of('/') + 1);
    const auto* format = grid_export::grid_format_of(name);
    return format != nullptr && format->check_directory != nullptr ? name : output;
}

Status check_output(const GridOptions& options, const InputFiles& inputs) {
    for (const InputFile& file : inputs.files()) {
        std::error_code ignored;
        if (std::filesystem::equivalent(file.path, options.output, ignored)) {
            return fail(ErrorCode::bad_argument, "{}: this is {} itself; name another file",
                        options.output,
                        options.files.size() == 1 ? "the input file" : "one of the input files");
        }
    }
    const auto* format = grid_export::grid_format_of(options.output);
    if (format != nullptr && format->check_directory != nullptr)
        return format->check_directory(options.output);
    return check_output_file(
        options.output, grid_export::grid_endings(),
        fmt::format("a grid is written as {}", grid_export::known_grid_formats()), options.json);
}

// Prints the plans, if requested. Errors: unmet for a plan that misses its budget.
Status report_plans(const GridOptions& options, const std::vector<MadeGrid>& all, bool explain) {
    const bool taken = options.json || is_stdout(options.output);
    for (const MadeGrid& made : all) {
        if (!made.plan) continue;
        if (explain && all.size() > 1) {
            fmt::print(taken ? stderr : stdout, "{}:\n", level2::moment_name(made.grid.moment));
        }
        if (explain) fmt::print(taken ? stderr : stdout, "{}", accuracy::explain(*made.plan));
        if (made.has_failed()) return fail(ErrorCode::unmet, "{}", made.plan->shortfall);
    }
    return {};
}

// Standard output has no file ending that chooses a format, so it gets the default format.
const grid_export::GridFormat& format_of(const GridOptions& options) {
    const auto* format = grid_export::grid_format_of(options.output);
    return format != nullptr ? *format : grid_export::grid_formats().front();
}

Status write_all(const GridOptions& options, const std::vector<grid::Grid>& grids,
                 const grid_export::GridFormatOptions& format_options) {
    auto output = OutputFile::open(options.output);
    if (!output) return pass_on(output);
    const auto written =
        format_of(options).write(real_file_system(), output->path(), grids, format_options);
    if (!written) return written;
    return output->finish();
}

// Prints notes. Prints a note only once if several moments have it.
void print_notes(const std::vector<grid::Grid>& grids, const std::vector<MomentRequest>& moments) {
    std::set<std::string> said;
    for (const grid::Grid& grid : grids) {
        const auto of = std::ranges::find(moments, grid.moment, &MomentRequest::moment);
        for (const std::string& note : notes_on(grid, of->effects)) {
            if (said.insert(note).second) print_note(note);
        }
    }
}

int run_grid(GridOptions options, const EffectOptions& effect_options,
             const MosaicOptions& mosaic_options, const SurfaceOptions& surface_options) {
    Stopwatch total;
    options.output = without_slash(options.output);
    const auto inputs = find_inputs(options);
    if (!inputs) return report_error(inputs.error());
    auto request = parse_request(options);
    if (!request) return report_error(request.error());
    request->inputs = *inputs;
    const auto moments = parse_each_moment(options, *request, effect_options, mosaic_options);
    if (!moments) return report_error(moments.error());
    GridTimings timings;
    if (auto writable = check_output(options, **inputs); !writable)
        return report_error(writable.error());
    std::vector<level2::Moment> names;
    for (const MomentRequest& moment : *moments)
        names.push_back(moment.moment);
    const auto surfaces = parse_surfaces(surface_options, format_of(options), names);
    if (!surfaces) return report_error(surfaces.error());
    auto made = grid_inputs(options.files, *request, *moments, timings);
    if (!made) return report_error(made.error());
    if (Status met = report_plans(options, *made, effect_options.explain); !met)
        return report_error(met.error());
    std::vector<grid::Grid> grids;
    for (MadeGrid& one : *made)
        grids.push_back(std::move(one.grid));
    Stopwatch watch;
    if (Status written = write_all(options, grids, *surfaces); !written)
        return report_error(written.error());
    timings.write_s = watch.lap_s();
    timings.total_s = total.lap_s();
    print_notes(grids, *moments);
    if (options.json) {
        const auto replace = nlohmann::ordered_json::error_handler_t::replace;
        fmt::print("{}\n", describe(options, grids, timings).dump(1, ' ', true, replace));
    } else {
        print_facts(options, grids, timings);
    }
    return exit_done;
}

}  // namespace

Run set_up_grid(CLI::App& grid) {
    const auto options = std::make_shared<GridOptions>();
    const auto effects = std::make_shared<EffectOptions>();
    const auto mosaic = std::make_shared<MosaicOptions>();
    add_grid_options(grid, *options);
    add_mosaic_options(grid, *mosaic, *effects);
    add_effect_options(grid, *effects);
    const auto surfaces = std::make_shared<SurfaceOptions>();
    add_surface_options(grid, *surfaces);
    return [=] { return run_grid(*options, *effects, *mosaic, *surfaces); };
}

}  // namespace stormcellar::cli
