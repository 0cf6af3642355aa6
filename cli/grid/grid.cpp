// stormcellar grid FILE... -o OUT.nc: decodes volumes, grids them, and writes the grid as netCDF.
#include <algorithm>
#include <array>
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "accuracy/explain.h"
#include "base/steady_time.h"
#include "cli/grid/grid_mosaic.h"
#include "cli/grid/grid_notes.h"
#include "cli/grid/grid_request.h"
#include "cli/grid/volume_source.h"
#include "cli/shared/commands.h"
#include "cli/shared/effect_options.h"
#include "cli/shared/output_file.h"
#include "grid/plan/grid_effects.h"
#include "grid/plan/position_error.h"
#include "stormcellar/base/file_system.h"
#include "stormcellar/export/grid_format.h"
#include "stormcellar/grid/column_geometry.h"
#include "stormcellar/grid/gridder.h"

namespace stormcellar::cli {
namespace {

struct Timings {
    double read_s = 0, decode_s = 0, geometry_s = 0, plan_s = 0, grid_s = 0, merge_s = 0;
    double write_s = 0, total_s = 0;
};

grid::GridderOptions gridder_options(const GridRequest& request, const EffectRequest& effects,
                                     const grid::Method& method) {
    grid::GridderOptions gridder;
    gridder.moment = request.moment;
    gridder.threads = request.threads;
    gridder.method = method;
    gridder.profile = effects.profile;
    gridder.details = request.details;
    gridder.frame_time = request.frame_time;
    if (request.frame_time) gridder.repeats = grid::GridderOptions::Repeats::nearest_in_time;
    return gridder;
}

// The grid, and the plan by which it was made, if a plan was requested.
struct Made {
    grid::Grid grid;
    std::optional<accuracy::Plan> plan;
};

// Without a plan: the default, changed by the settings of the effects.
Result<grid::Grid> grid_plainly(const SourceVolume& source, const grid::GridSpec& spec,
                                const GridRequest& request, const EffectRequest& effects,
                                Timings& timings) {
    Stopwatch watch;
    const double beam_width_deg = grid::beam_width_of(source.site.icao);
    const accuracy::Choice rungs = grid::default_choice(effects.chain, spec, beam_width_deg);
    const grid::SceneChoice choice = grid::scene_choice(effects.chain, rungs);
    const auto geometry = grid::make_column_geometry(source.site, spec, choice.frame);
    timings.geometry_s = watch.lap_s();
    if (!geometry) return pass_on(geometry);
    const grid::GridderOptions options = gridder_options(request, effects, choice.method);
    auto made = grid::make_grid(source.volume, source.site, **geometry, options);
    timings.grid_s = watch.lap_s();
    if (made) {
        made->provenance.effects = accuracy::describe(effects.chain, rungs);
        made->provenance.predicted_error =
            grid::unplanned_error(source.volume, source.site, spec, choice.frame, options);
    }
    return made;
}

Result<Made> grid_by_plan(const SourceVolume& source, const grid::GridSpec& spec,
                          const GridRequest& request, const EffectRequest& effects,
                          Timings& timings) {
    Stopwatch watch;
    auto scene = grid::GridScene::make(
        source.volume, source.site, spec,
        {request.moment, 0, effects.profile, request.threads, request.frame_time});
    if (!scene) return pass_on(scene);
    auto planned = grid::plan_grid(*scene, effects.chain, effects.budget);
    timings.plan_s = watch.lap_s();
    if (!planned) return pass_on(planned);
    Made made;
    made.plan = std::move(planned->plan);
    if (!made.plan->meets_budget) return made;
    const auto geometry = scene->geometry(planned->choice.frame);
    timings.geometry_s = watch.lap_s();
    if (!geometry) return pass_on(geometry);
    auto grid = grid::make_grid(source.volume, source.site, **geometry,
                                gridder_options(request, effects, planned->choice.method));
    timings.grid_s = watch.lap_s();
    if (!grid) return pass_on(grid);
    made.grid = std::move(*grid);
    made.grid.provenance.predicted_error = grid::predicted_error(*made.plan);
    made.grid.provenance.effects = made.plan->description;
    return made;
}

Result<Made> grid_file(const std::string& path, const GridRequest& request,
                       const EffectRequest& effects, Timings& timings) {
    auto source = load_volume(path, request);
    if (!source) return pass_on(source);
    timings.read_s = source->read_s;
    timings.decode_s = source->decode_s;
    const auto [latitude_deg, longitude_deg] = request.center_deg.value_or(
        std::array<double, 2>{source->site.latitude_deg, source->site.longitude_deg});
    const auto spec = spec_about(request, latitude_deg, longitude_deg);
    if (!spec) return pass_on(spec);
    const auto name_file = [&](const Error& error) -> Result<Made> {
        return fail(error.code, "{}: {}", path, error.message);
    };
    Made made;
    if (effects.needs_plan()) {
        auto planned = grid_by_plan(*source, *spec, request, effects, timings);
        if (!planned) return name_file(planned.error());
        made = std::move(*planned);
    } else {
        auto grid = grid_plainly(*source, *spec, request, effects, timings);
        if (!grid) return name_file(grid.error());
        made.grid = std::move(*grid);
    }
    grid::Provenance& provenance = made.grid.provenance;
    provenance.source_files = {std::filesystem::path{path}.filename().string()};
    provenance.partial = source->partial;
    provenance.notes.insert(provenance.notes.begin(), source->notes.begin(), source->notes.end());
    return made;
}

std::array<std::size_t, 4> count_states(const grid::Grid& grid) {
    std::array<std::size_t, 4> counts{};
    for (const grid::CellStatus status : grid.status)
        ++counts[static_cast<std::size_t>(status)];
    return counts;
}

nlohmann::ordered_json describe(const GridOptions& options, const grid::Grid& grid,
                                const Timings& timings) {
    nlohmann::ordered_json json;
    json["file"] = std::filesystem::path(options.files.front()).filename().string();
    json["files"] = grid.provenance.source_files;
    json["output"] = options.output;
    json["station"] = grid.sites.front().icao;
    json["stations"] = grid.provenance.stations;
    json["time"] = format_utc(grid.time);
    json["frame_time"] = format_utc(grid.frame_time.value_or(grid.time));
    json["moment"] = level2::moment_name(grid.moment);
    json["units"] = level2::moment_units(grid.moment);
    json["projection"] = grid::projection_name(grid.spec.projection);
    json["center"] = {grid.spec.center_latitude_deg, grid.spec.center_longitude_deg};
    if (grid.spec.in_degrees()) {
        json["spacing_deg"] = grid.spec.spacing_deg;
    } else {
        json["spacing_m"] = grid.spec.spacing_m;
    }
    if (grid::facts_of(grid.spec.projection).takes_parallels) {
        json["parallels_deg"] = grid.spec.parallels_deg;
    }
    json["nx"] = grid.spec.nx;
    json["ny"] = grid.spec.ny;
    json["levels_m"] = grid.spec.levels_m;
    const auto counts = count_states(grid);
    for (std::size_t state = 0; state < counts.size(); ++state)
        json["cells"][std::string{grid::cell_status_name(static_cast<grid::CellStatus>(state))}] =
            counts[state];
    json["fields"] = nlohmann::ordered_json::array();
    for (const grid::Detail detail : grid::all_details) {
        if (grid.details.set().has(detail)) json["fields"].push_back(grid::detail_name(detail));
    }
    if (!grid.site_counts.empty()) json["fields"].push_back("counts");
    if (!grid.site_weights.empty()) json["fields"].push_back("weights");
    json["method"] = grid.provenance.method;
    json["beam_model"] = grid.provenance.beam_model;
    json["averaging"] = grid.provenance.averaging;
    if (!grid.provenance.predicted_error.empty()) {
        json["effects"] = grid.provenance.effects;
        json["predicted_error"] = grid.provenance.predicted_error;
    }
    json["partial"] = grid.provenance.partial;
    json["notes"] = grid.provenance.notes;
    json["read_s"] = timings.read_s;
    json["decode_s"] = timings.decode_s;
    json["geometry_s"] = timings.geometry_s;
    json["plan_s"] = timings.plan_s;
    json["grid_s"] = timings.grid_s;
    json["merge_s"] = timings.merge_s;
    json["write_s"] = timings.write_s;
    json["total_s"] = timings.total_s;
    return json;
}

void print_facts(const GridOptions& options, const grid::Grid& grid, const Timings& timings) {
    std::FILE* const to = is_stdout(options.output) ? stderr : stdout;
    const auto counts = count_states(grid);
    const auto percent = [&](grid::CellStatus status) {
        return 100.0 * static_cast<double>(counts[static_cast<std::size_t>(status)]) /
               static_cast<double>(grid.status.size());
    };
    const bool in_degrees = grid.spec.in_degrees();
    fmt::print(to, "{}: {} {} of {}, {} x {} x {} cells at {:g} {}\n", printable(options.output),
               printable(fmt::format("{}", fmt::join(grid.provenance.stations, " "))),
               level2::moment_name(grid.moment), format_utc(grid.time), grid.spec.nx, grid.spec.ny,
               grid.spec.nz(), in_degrees ? grid.spec.spacing_deg : grid.spec.spacing_m / 1000,
               in_degrees ? "degrees" : "km");
    fmt::print(to,
               "  {:.1f} % with a value, {:.1f} % no echo, {:.1f} % range folded, {:.1f} % not "
               "seen\n",
               percent(grid::CellStatus::value), percent(grid::CellStatus::no_echo),
               percent(grid::CellStatus::range_folded), percent(grid::CellStatus::not_seen));
    for (const std::string& note : grid.provenance.notes)
        fmt::print(to, "  note: {}\n", printable(note));
    fmt::print(
        to,
        "  read {:.3f} s, decode {:.3f} s, geometry {:.3f} s, grid {:.3f} s, merge {:.3f} s, "
        "write {:.3f} s\n",
        timings.read_s, timings.decode_s, timings.geometry_s, timings.grid_s, timings.merge_s,
        timings.write_s);
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

Result<Made> grid_files(const GridOptions& options, const grid::MosaicOptions& mosaic,
                        const GridRequest& request, const EffectRequest& effects,
                        Timings& timings) {
    const auto sources = load_mosaic(options.files, request);
    if (!sources) return pass_on(sources);
    auto made = pipeline::make_mosaic(sources->scene_volumes(),
                                      mosaic_request(*sources, request, mosaic, effects));
    if (!made) return pass_on(made);
    timings.read_s = sources->read_s;
    timings.decode_s = sources->decode_s;
    timings.plan_s = made->plan_s;
    timings.grid_s = made->grid_s;
    timings.merge_s = made->merge_s;
    return Made{std::move(made->grid), std::move(made->plan)};
}

int run_grid(GridOptions options, const EffectOptions& effect_options,
             const MosaicOptions& mosaic_options) {
    Stopwatch total;
    const auto inputs = find_inputs(options);
    if (!inputs) return report_error(inputs.error());
    auto request = parse_request(options);
    if (!request) return report_error(request.error());
    request->inputs = *inputs;
    const bool is_mosaic = options.files.size() > 1;
    const auto mosaic =
        parse_mosaic(mosaic_options, effect_options, options.files.size(), *request);
    if (!mosaic) return report_error(mosaic.error());
    const auto effects = parse_effects(effect_options, request->moment,
                                       is_mosaic ? std::optional(mosaic->overlap) : std::nullopt);
    if (!effects) return report_error(effects.error());
    Timings timings;
    if (auto writable = check_output(options, **inputs); !writable)
        return report_error(writable.error());
    const auto made = is_mosaic ? grid_files(options, *mosaic, *request, *effects, timings)
                                : grid_file(options.files.front(), *request, *effects, timings);
    if (!made) return report_error(made.error());
    if (made->plan && effect_options.explain) {
        const bool taken = options.json || is_stdout(options.output);
        fmt::print(taken ? stderr : stdout, "{}", accuracy::explain(*made->plan));
    }
    if (made->plan && !made->plan->meets_budget) {
        return report_error({ErrorCode::unmet, made->plan->shortfall});
    }
    Stopwatch watch;
    auto output = OutputFile::open(options.output);
    if (!output) return report_error(output.error());
    const auto* format = grid_export::grid_format_of(options.output);
    // Standard output has no ending and takes the default.
    if (format == nullptr) format = &grid_export::grid_formats().front();
    const auto written = format->write(real_file_system(), output->path(), made->grid);
    if (!written) return report_error(written.error());
    if (Status done = output->finish(); !done) return report_error(done.error());
    timings.write_s = watch.lap_s();
    timings.total_s = total.lap_s();
    for (const std::string& note : notes_on(made->grid, *effects))
        print_note(note);
    if (options.json) {
        const auto replace = nlohmann::ordered_json::error_handler_t::replace;
        fmt::print("{}\n", describe(options, made->grid, timings).dump(1, ' ', true, replace));
    } else {
        print_facts(options, made->grid, timings);
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
