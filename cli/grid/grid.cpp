// stormcellar grid FILE... -o OUT.nc: decodes volumes, grids them, and writes the grid as netCDF.
#include <algorithm>
#include <array>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "accuracy/explain.h"
#include "base/steady_time.h"
#include "cli/grid/grid_mosaic.h"
#include "cli/grid/grid_notes.h"
#include "cli/grid/grid_report.h"
#include "cli/grid/grid_request.h"
#include "cli/grid/volume_source.h"
#include "cli/shared/commands.h"
#include "cli/shared/effect_options.h"
#include "cli/shared/output_file.h"
#include "grid/plan/grid_effects.h"
#include "grid/plan/position_error.h"
#include "level2/decode/volume_checks.h"
#include "pipeline/keep/geometry_cache.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/export/grid_format.h"
#include "stormcellar/grid/gridder.h"

namespace stormcellar::cli {
namespace {

// A table of the site frame, and the exact geometry.
constexpr std::size_t most_geometries = 2;

// What the options say of one moment.
struct MomentRequest {
    level2::Moment moment = level2::Moment::ref;
    EffectRequest effects;
    grid::MosaicOptions mosaic;  // of several files
};

grid::GridderOptions gridder_options(const GridRequest& request, const MomentRequest& of,
                                     const grid::Method& method) {
    grid::GridderOptions gridder;
    gridder.moment = of.moment;
    gridder.threads = request.threads;
    gridder.method = method;
    gridder.profile = of.effects.profile;
    gridder.details = request.details;
    gridder.frame_time = request.frame_time;
    if (request.frame_time) gridder.repeats = grid::GridderOptions::Repeats::nearest_in_time;
    return gridder;
}

// A grid, and the plan by which it was made, if a plan was requested.
struct Made {
    grid::Grid grid;
    std::optional<accuracy::Plan> plan;
};

// The moments of one file that are gridded share what is here.
struct FileScene {
    const SourceVolume& source;
    grid::GridSpec spec;
    pipeline::GeometryCache geometries{most_geometries};
};

// Without a plan: the default, changed by the settings of the effects.
Result<Made> grid_plainly(FileScene& scene, const GridRequest& request, const MomentRequest& of,
                          GridTimings& timings) {
    Stopwatch watch;
    const level2::Volume& volume = scene.source.volume;
    const grid::SitePosition& site = scene.source.site;
    const double beam_width_deg = grid::beam_width_of(site.icao);
    const accuracy::Choice rungs =
        grid::default_choice(of.effects.chain, scene.spec, beam_width_deg);
    const grid::SceneChoice choice = grid::scene_choice(of.effects.chain, rungs);
    const auto geometry = scene.geometries.get(site, scene.spec, choice.frame);
    timings.geometry_s += watch.lap_s();
    if (!geometry) return pass_on(geometry);
    const grid::GridderOptions options = gridder_options(request, of, choice.method);
    auto grid = grid::make_grid(volume, site, **geometry, options);
    timings.grid_s += watch.lap_s();
    if (!grid) return pass_on(grid);
    grid->provenance.effects = accuracy::describe(of.effects.chain, rungs);
    grid->provenance.predicted_error =
        grid::unplanned_error(volume, site, scene.spec, choice.frame, options);
    return Made{std::move(*grid), {}};
}

Result<Made> grid_by_plan(FileScene& scene, const GridRequest& request, const MomentRequest& of,
                          GridTimings& timings) {
    Stopwatch watch;
    const SourceVolume& source = scene.source;
    auto measured = grid::GridScene::make(
        source.volume, source.site, scene.spec,
        {of.moment, 0, of.effects.profile, request.threads, request.frame_time});
    if (!measured) return pass_on(measured);
    auto planned = grid::plan_grid(*measured, of.effects.chain, of.effects.budget);
    timings.plan_s += watch.lap_s();
    if (!planned) return pass_on(planned);
    Made made;
    made.plan = std::move(planned->plan);
    if (!made.plan->meets_budget) return made;
    const auto geometry = measured->geometry(planned->choice.frame);
    timings.geometry_s += watch.lap_s();
    if (!geometry) return pass_on(geometry);
    auto grid = grid::make_grid(source.volume, source.site, **geometry,
                                gridder_options(request, of, planned->choice.method));
    timings.grid_s += watch.lap_s();
    if (!grid) return pass_on(grid);
    made.grid = std::move(*grid);
    made.grid.provenance.predicted_error = grid::predicted_error(*made.plan);
    made.grid.provenance.effects = made.plan->description;
    return made;
}

bool has_failed(const Made& made) {
    return made.plan && !made.plan->meets_budget;
}

// Returns true if the moment is gridded: one that was named always, and of all that the volumes may
// hold those that one of them holds.
bool is_gridded(const GridRequest& request, level2::Moment moment,
                const std::vector<const level2::Volume*>& volumes) {
    const auto has = [&](const level2::Volume* volume) { return level2::holds(*volume, moment); };
    return !request.any_moment || std::ranges::any_of(volumes, has);
}

// Returns a grid of each moment; after one that does not meet its budget there are no more.
Result<std::vector<Made>> grid_file(const std::string& path, const GridRequest& request,
                                    const std::vector<MomentRequest>& moments,
                                    GridTimings& timings) {
    auto source = load_volume(path, request);
    if (!source) return pass_on(source);
    timings.read_s = source->read_s;
    timings.decode_s = source->decode_s;
    const auto [latitude_deg, longitude_deg] = request.center_deg.value_or(
        std::array<double, 2>{source->site.latitude_deg, source->site.longitude_deg});
    const auto spec = spec_about(request, latitude_deg, longitude_deg);
    if (!spec) return pass_on(spec);
    FileScene scene{*source, *spec};
    std::vector<Made> all;
    for (const MomentRequest& of : moments) {
        if (!is_gridded(request, of.moment, {&source->volume})) continue;
        auto made = of.effects.needs_plan() ? grid_by_plan(scene, request, of, timings)
                                            : grid_plainly(scene, request, of, timings);
        if (!made) return fail(made.error().code, "{}: {}", path, made.error().message);
        grid::Provenance& provenance = made->grid.provenance;
        provenance.source_files = {std::filesystem::path{path}.filename().string()};
        provenance.partial = source->partial;
        provenance.notes.insert(provenance.notes.begin(), source->notes.begin(),
                                source->notes.end());
        all.push_back(std::move(*made));
        if (has_failed(all.back())) break;
    }
    if (all.empty()) return fail(ErrorCode::not_found, "{}: the volume holds no moment", path);
    return all;
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
    return check_output_file(
        options.output, grid_export::grid_endings(),
        fmt::format("a grid is written as {}", grid_export::known_grid_formats()), options.json);
}

// All moments are brought to one instant: the one that was asked for, or that of the first moment.
Result<std::vector<Made>> grid_files(const GridOptions& options, GridRequest request,
                                     const std::vector<MomentRequest>& moments,
                                     GridTimings& timings) {
    const auto sources = load_mosaic(options.files, request);
    if (!sources) return pass_on(sources);
    timings.read_s = sources->read_s;
    timings.decode_s = sources->decode_s;
    std::vector<const level2::Volume*> volumes;
    for (const SourceVolume& source : sources->volumes)
        volumes.push_back(&source.volume);
    pipeline::GeometryCache geometries(pipeline::mosaic_geometries);
    std::vector<Made> all;
    for (const MomentRequest& of : moments) {
        if (!is_gridded(request, of.moment, volumes)) continue;
        const auto scene =
            request.any_moment ? sources->scene_volumes(of.moment) : sources->scene_volumes();
        auto made = pipeline::make_mosaic(
            scene, mosaic_request(*sources, request, of.mosaic, of.effects), geometries);
        if (!made) return pass_on(made);
        timings.plan_s += made->plan_s;
        timings.grid_s += made->grid_s;
        timings.merge_s += made->merge_s;
        all.push_back({std::move(made->grid), std::move(made->plan)});
        if (has_failed(all.back())) break;
        request.frame_time = all.back().grid.frame_time;
    }
    if (all.empty()) return fail(ErrorCode::not_found, "the volumes hold no moment");
    return all;
}

Result<std::vector<MomentRequest>> parse_each_moment(const GridOptions& options,
                                                     const GridRequest& request,
                                                     const EffectOptions& effect_options,
                                                     const MosaicOptions& mosaic_options) {
    const bool is_mosaic = options.files.size() > 1;
    std::vector<MomentRequest> all;
    for (const level2::Moment moment : request.moments()) {
        auto mosaic =
            parse_mosaic(mosaic_options, effect_options, options.files.size(), request, moment);
        if (!mosaic) return pass_on(mosaic);
        auto effects = parse_effects(effect_options, moment,
                                     is_mosaic ? std::optional(mosaic->overlap) : std::nullopt);
        if (!effects) return pass_on(effects);
        all.push_back({moment, std::move(*effects), *mosaic});
    }
    return all;
}

// Prints the plans, where they were asked for. Errors: unmet for a plan that misses its budget.
Status report_plans(const GridOptions& options, const std::vector<Made>& all, bool explain) {
    const bool taken = options.json || is_stdout(options.output);
    for (const Made& made : all) {
        if (!made.plan) continue;
        if (explain && all.size() > 1) {
            fmt::print(taken ? stderr : stdout, "{}:\n", level2::moment_name(made.grid.moment));
        }
        if (explain) fmt::print(taken ? stderr : stdout, "{}", accuracy::explain(*made.plan));
        if (has_failed(made)) return fail(ErrorCode::unmet, "{}", made.plan->shortfall);
    }
    return {};
}

Status write_all(const GridOptions& options, const std::vector<grid::Grid>& grids) {
    auto output = OutputFile::open(options.output);
    if (!output) return pass_on(output);
    const auto* format = grid_export::grid_format_of(options.output);
    // Standard output has no ending and takes the default.
    if (format == nullptr) format = &grid_export::grid_formats().front();
    const auto written = format->write(real_file_system(), output->path(), grids);
    if (!written) return written;
    return output->finish();
}

// A note that several moments give alike is printed once.
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
             const MosaicOptions& mosaic_options) {
    Stopwatch total;
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
    auto made = options.files.size() > 1
                    ? grid_files(options, *request, *moments, timings)
                    : grid_file(options.files.front(), *request, *moments, timings);
    if (!made) return report_error(made.error());
    if (Status met = report_plans(options, *made, effect_options.explain); !met)
        return report_error(met.error());
    std::vector<grid::Grid> grids;
    for (Made& one : *made)
        grids.push_back(std::move(one.grid));
    Stopwatch watch;
    if (Status written = write_all(options, grids); !written) return report_error(written.error());
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
    return [=] { return run_grid(*options, *effects, *mosaic); };
}

}  // namespace stormcellar::cli
