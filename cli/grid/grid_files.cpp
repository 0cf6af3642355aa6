#include "cli/grid/grid_files.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <utility>

#include "base/steady_time.h"
#include "grid/plan/grid_effects.h"
#include "grid/plan/position_error.h"
#include "level2/decode/volume_checks.h"
#include "pipeline/keep/geometry_cache.h"
#include "pipeline/plan/mosaic_of_volumes.h"
#include "retrieve/plan/dealiasing_plan.h"
#include "stormcellar/grid/gridder.h"

namespace stormcellar::cli {
namespace {

// Number of geometry tables that are kept for one file: the table of the site frame (which places
// cells as seen from the site), and the exact table.
constexpr std::size_t most_geometries = 2;

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

// Data that all moments gridded from one file share.
struct FileScene {
    const SourceVolume& source;
    grid::GridSpec spec;
    const std::optional<accuracy::Plan>& dealiasing;  // none: not planned
    pipeline::GeometryCache geometries{most_geometries};
};

// Grids without a plan: uses the default choice for each step, changed by the effects that were
// typed.
Result<MadeGrid> grid_plainly(FileScene& scene, const GridRequest& request, const MomentRequest& of,
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
    return MadeGrid{std::move(*grid), {}};
}

// Returns the part of the budget that a plan of dealiasing leaves for the grid.
std::optional<accuracy::Budget> budget_beside(const accuracy::Plan& dealiasing,
                                              std::optional<accuracy::Budget> budget) {
    if (!budget) return budget;
    if (budget->value) *budget->value -= dealiasing.left_off.value;
    if (budget->time_s) *budget->time_s -= dealiasing.cost_s;
    return budget;
}

// Joins the plan of dealiasing, which comes first, and the plan of the grid.
accuracy::Plan join_plans(const accuracy::Plan& dealiasing, accuracy::Plan plan) {
    plan.budget = dealiasing.budget;
    plan.description = dealiasing.description + ", " + plan.description;
    plan.left_off += dealiasing.left_off;
    plan.cost_s += dealiasing.cost_s;
    if (plan.measured && plan.measured->value) *plan.measured->value += dealiasing.left_off.value;
    plan.decisions.insert(plan.decisions.begin(), dealiasing.decisions.begin(),
                          dealiasing.decisions.end());
    return plan;
}

Result<MadeGrid> grid_by_plan(FileScene& scene, const GridRequest& request, const MomentRequest& of,
                              GridTimings& timings) {
    Stopwatch watch;
    const SourceVolume& source = scene.source;
    auto measured = grid::GridScene::make(
        source.volume, source.site, scene.spec,
        {of.moment, 0, of.effects.profile, request.threads, request.frame_time});
    if (!measured) return pass_on(measured);
    const bool is_dealiased = scene.dealiasing && level2::is_dealiased(of.moment);
    const auto budget =
        is_dealiased ? budget_beside(*scene.dealiasing, of.effects.budget) : of.effects.budget;
    auto planned = grid::plan_grid(*measured, of.effects.chain, budget);
    timings.plan_s += watch.lap_s();
    if (!planned) return pass_on(planned);
    MadeGrid made;
    made.plan = is_dealiased ? join_plans(*scene.dealiasing, std::move(planned->plan))
                             : std::move(planned->plan);
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

// Returns true if the moment must be gridded. A named moment is always gridded. With "all", a
// moment is gridded if one of the volumes has it.
bool is_gridded(const GridRequest& request, level2::Moment moment,
                const std::vector<const level2::Volume*>& volumes) {
    const auto has = [&](const level2::Volume* volume) { return level2::holds(*volume, moment); };
    return !request.any_moment || std::ranges::any_of(volumes, has);
}

// Returns the request. If a derived moment needs a plan, the request plans the dealiasing, too.
GridRequest planning_dealiasing(GridRequest request, const std::vector<MomentRequest>& moments,
                                std::optional<accuracy::Plan>& plan) {
    const auto planned = std::ranges::find_if(moments, [](const MomentRequest& of) {
        return level2::is_dealiased(of.moment) && of.effects.needs_plan();
    });
    if (planned == moments.end()) return request;
    request.plan_dealiasing = [&plan, asked = request.derived.dealiasing,
                               budget = planned->effects.budget](
                                  const level2::Volume& volume) -> Result<retrieve::Dealiasing> {
        auto made = retrieve::plan_dealiasing(volume, asked, budget);
        if (!made) return pass_on(made);
        plan = std::move(made->plan);
        return made->rung;
    };
    return request;
}

// Returns a grid of each requested moment. Stops after the first grid that does not meet its
// budget.
Result<std::vector<MadeGrid>> grid_file(const std::string& path, const GridRequest& request,
                                        const std::vector<MomentRequest>& moments,
                                        GridTimings& timings, std::vector<SourceVolume>* kept) {
    std::optional<accuracy::Plan> dealiasing;
    auto source = load_volume(path, planning_dealiasing(request, moments, dealiasing));
    if (!source) return pass_on(source);
    if (dealiasing && !dealiasing->meets_budget) return std::vector{MadeGrid{{}, dealiasing}};
    timings.read_s = source->read_s;
    timings.decode_s = source->decode_s;
    const auto spec = spec_about(request, source->site.latitude_deg, source->site.longitude_deg);
    if (!spec) return pass_on(spec);
    FileScene scene{*source, *spec, dealiasing};
    std::vector<MadeGrid> all;
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
        if (all.back().has_failed()) break;
    }
    if (all.empty()) return fail(ErrorCode::not_found, "{}: the volume holds no moment", path);
    if (kept != nullptr) kept->push_back(std::move(*source));
    return all;
}

// Merges the files into grids for one instant: the requested time, or else the instant that the
// first moment's mosaic chooses.
Result<std::vector<MadeGrid>> grid_files(const std::vector<std::string>& files, GridRequest request,
                                         const std::vector<MomentRequest>& moments,
                                         GridTimings& timings, std::vector<SourceVolume>* kept) {
    auto sources = load_mosaic(files, request);
    if (!sources) return pass_on(sources);
    timings.read_s = sources->read_s;
    timings.decode_s = sources->decode_s;
    std::vector<const level2::Volume*> volumes;
    for (const SourceVolume& source : sources->volumes)
        volumes.push_back(&source.volume);
    pipeline::GeometryCache geometries(pipeline::mosaic_geometries);
    std::vector<MadeGrid> all;
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
        if (all.back().has_failed()) break;
        request.frame_time = all.back().grid.frame_time;
    }
    if (all.empty()) return fail(ErrorCode::not_found, "the volumes hold no moment");
    if (kept != nullptr) *kept = std::move(sources->volumes);
    return all;
}

}  // namespace

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

Result<std::vector<MadeGrid>> grid_inputs(const std::vector<std::string>& files,
                                          const GridRequest& request,
                                          const std::vector<MomentRequest>& moments,
                                          GridTimings& timings, std::vector<SourceVolume>* kept) {
    if (files.size() > 1) return grid_files(files, request, moments, timings, kept);
    return grid_file(files.front(), request, moments, timings, kept);
}

}  // namespace stormcellar::cli
