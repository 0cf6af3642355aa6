#include "cli/grid/grid_mosaic.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <CLI/CLI.hpp>

#include "base/stopwatch.h"
#include "cli/shared/commands.h"
#include "grid/plan/effects.h"
#include "stormcellar/grid/projection.h"
#include "stormcellar/grid/site_frame.h"

namespace stormcellar::cli {
namespace {

constexpr std::chrono::milliseconds greatest_gap = pipeline::FrameOptions{}.greatest_gap;
constexpr double beyond_sites_m = 230'000;  // what a mosaic shows beyond its outermost sites

// Returns the middle of the box that holds the sites, by the shorter way around the earth.
std::array<double, 2> middle_of(const std::vector<grid::SitePosition>& sites) {
    const double base_deg = sites.front().longitude_deg;
    double south = 90, north = -90, west = 360, east = -360;
    for (const grid::SitePosition& site : sites) {
        const double off_deg = std::remainder(site.longitude_deg - base_deg, 360.0);
        south = std::min(south, site.latitude_deg);
        north = std::max(north, site.latitude_deg);
        west = std::min(west, off_deg);
        east = std::max(east, off_deg);
    }
    const double longitude_deg = std::remainder(base_deg + (west + east) / 2, 360.0);
    return {(south + north) / 2, longitude_deg};
}

// Returns whole cells that hold all sites and 230 km around them, in kilometers.
std::array<double, 2> extent_km_of(const std::vector<grid::SitePosition>& sites,
                                   const std::array<double, 2>& center_deg, double spacing_km) {
    const grid::SiteFrame frame(center_deg[0], center_deg[1]);
    double half_x_m = 0, half_y_m = 0;
    for (const grid::SitePosition& site : sites) {
        const auto place =
            grid::SiteFrame::to_plane(frame.to_polar({site.latitude_deg, site.longitude_deg}));
        half_x_m = std::max(half_x_m, std::abs(place.x_m));
        half_y_m = std::max(half_y_m, std::abs(place.y_m));
    }
    const auto whole = [&](double half_m) {
        const double cells = std::ceil((half_m + beyond_sites_m) / 1000 / spacing_km);
        return 2 * cells * spacing_km;
    };
    return {whole(half_x_m), whole(half_y_m)};
}

// For one site, because the beam is as wide as that of its radar.
accuracy::Choice default_of(const EffectRequest& effects, const grid::GridSpec& spec,
                            const grid::SitePosition& site) {
    return pipeline::default_mosaic_choice(effects.chain, spec, grid::beam_width_of(site.icao));
}

pipeline::PartialOptions partial_options(const GridRequest& request, const EffectRequest& effects) {
    pipeline::PartialOptions options;
    options.gridder.moment = request.moment;
    options.gridder.threads = request.threads;
    options.gridder.profile = effects.profile;
    return options;
}

pipeline::FrameOptions frame_options(const GridRequest& request, const grid::MosaicOptions& overlap,
                                     const EffectRequest& effects) {
    pipeline::FrameOptions options;
    options.overlap = overlap;
    options.overlap.averaging = effects.averaging;
    options.threads = request.threads;
    return options;
}

std::vector<grid::SitePosition> sites_of(const std::vector<SourceVolume>& sources) {
    std::vector<grid::SitePosition> sites;
    for (const SourceVolume& source : sources) {
        const auto is_it = [&](const grid::SitePosition& site) {
            return site.icao == source.site.icao;
        };
        if (std::none_of(sites.begin(), sites.end(), is_it)) sites.push_back(source.site);
    }
    return sites;
}

grid::Grid dense_of(const pipeline::MosaicFrame& frame) {
    grid::Grid grid = grid::to_dense(frame.mosaic.cells.view());
    grid.moment = frame.description.moment;
    grid.time = frame.description.time;
    grid.start_time = frame.description.start_time;
    grid.end_time = frame.description.end_time;
    grid.frame_time = frame.description.time;
    grid.sites = frame.description.sites;
    grid.provenance = frame.description.provenance;
    // If no site sees a cell, both are 0, which is how to_dense() leaves cells without a value.
    if (frame.mosaic.counts) {
        const grid::Grid counts = grid::to_dense(frame.mosaic.counts->view());
        grid.site_counts.assign(counts.values.begin(), counts.values.end());
    }
    if (frame.mosaic.weights) {
        grid.site_weights = std::move(grid::to_dense(frame.mosaic.weights->view()).values);
    }
    return grid;
}

// Returns the middle of the time that a volume covers.
std::optional<UtcTime> middle_time(const level2::Volume& volume) {
    const std::optional<UtcTime> start = volume.start_time();
    if (!start) return std::nullopt;
    UtcTime end = *start;
    for (const level2::Sweep& sweep : volume.sweeps) {
        for (const level2::Radial& radial : sweep.radials) {
            if (level2::is_time_of_volume(radial.time, start)) end = std::max(end, radial.time);
        }
    }
    return *start + (end - *start) / 2;
}

// Notes the volumes that are too far from the instant.
void note_left_out(const MosaicSources& sources, const grid::Grid& grid,
                   std::vector<std::string>& notes) {
    const auto& used = grid.provenance.source_files;
    for (std::size_t i = 0; i < sources.volumes.size(); ++i) {
        const std::string file = std::filesystem::path(sources.files[i]).filename().string();
        if (std::ranges::find(used, file) != used.end()) continue;
        const auto middle = middle_time(sources.volumes[i].volume);
        if (!middle || std::chrono::abs(*middle - grid.time) <= greatest_gap) continue;
        notes.push_back(fmt::format(
            "{}: {} is left out: its middle, {}, is more than 15 minutes from {}",
            sources.volumes[i].site.icao, file, format_utc(*middle), format_utc(grid.time)));
    }
}

}  // namespace

Result<grid::GridSpec> mosaic_spec(const std::vector<grid::SitePosition>& sites,
                                   GridRequest request) {
    if (sites.empty() && !request.center_deg) {
        return fail(ErrorCode::bad_argument, "no station says where the grid lies: give --center");
    }
    const auto center = request.center_deg ? *request.center_deg : middle_of(sites);
    const bool in_km = request.extent_unit == SizeUnit::km && request.spacing_unit == SizeUnit::km;
    if (!request.extent_given && in_km && !sites.empty()) {
        request.extent = extent_km_of(sites, center, request.spacing);
    }
    return spec_about(request, center[0], center[1]);
}

void add_mosaic_options(CLI::App& app, MosaicOptions& options, EffectOptions& effects) {
    app.add_option("--overlap", options.overlap,
                   "Where several sites see a cell: distance-weighted (the default), mean, maximum "
                   "or nearest (all that VEL and PHI allow)");
    app.add_option("--overlap-km", options.overlap_km,
                   "L of the weight exp(-r^2/L^2) of a site r away; else 250");
    app.add_option("--time-method", effects.time_method,
                   "Between two volumes of a site: advected (the default), blend or nearest");
}

Result<grid::MosaicOptions> parse_mosaic(const MosaicOptions& options, const EffectOptions& effects,
                                         std::size_t files, const GridRequest& request) {
    grid::MosaicOptions mosaic;
    if (files == 1) {
        const std::string_view given = !options.overlap.empty()       ? "--overlap"
                                       : options.overlap_km           ? "--overlap-km"
                                       : !effects.time_method.empty() ? "--time-method"
                                                                      : "";
        if (given.empty()) return mosaic;
        return fail(ErrorCode::bad_argument, "{} is for several FILEs", given);
    }
    mosaic.moment = request.moment;
    mosaic.overlap = grid::default_overlap(request.moment);
    mosaic.threads = request.threads;
    mosaic.counts = request.site_counts;
    mosaic.weights = request.site_weights;
    if (!options.overlap.empty()) {
        const auto overlap = grid::overlap_from_name(options.overlap);
        if (!overlap) {
            return fail(ErrorCode::bad_argument,
                        "--overlap takes one of distance-weighted, mean, maximum, nearest, not "
                        "'{}'",
                        options.overlap);
        }
        mosaic.overlap = *overlap;
    }
    if (options.overlap_km) {
        if (!(*options.overlap_km >= 1 && *options.overlap_km <= 10'000)) {
            return fail(ErrorCode::bad_argument, "--overlap-km must be 1 to 10000, not {}",
                        *options.overlap_km);
        }
        mosaic.length_m = *options.overlap_km * 1000;
    }
    return mosaic;
}

std::vector<pipeline::SceneVolume> MosaicSources::scene_volumes() const {
    std::vector<pipeline::SceneVolume> made;
    for (std::size_t at = 0; at < volumes.size(); ++at) {
        const SourceVolume& source = volumes[at];
        made.push_back({&source.volume, source.site, files[at], source.partial, source.notes});
    }
    return made;
}

std::size_t MosaicSources::site_count() const {
    return sites_of(volumes).size();
}

Result<MosaicSources> load_mosaic(const std::vector<std::string>& files,
                                  const GridRequest& request) {
    MosaicSources sources;
    for (const std::string& file : files) {
        auto source = load_volume(file, request);
        if (!source && request.inputs && request.inputs->is_found(file) &&
            is_no_volume(source.error())) {
            print_note(fmt::format("left out: {}", source.error().message));
            continue;
        }
        if (!source) return pass_on(source);
        sources.files.push_back(file);
        sources.timings.read_s += source->read_s;
        sources.timings.decode_s += source->decode_s;
        sources.volumes.push_back(std::move(*source));
    }
    if (sources.volumes.empty()) {
        return fail(ErrorCode::not_found, "none of the {} files is a Level II volume",
                    files.size());
    }
    auto spec = mosaic_spec(sites_of(sources.volumes), request);
    if (!spec) return pass_on(spec);
    sources.spec = std::move(*spec);
    return sources;
}

Result<std::vector<pipeline::MadePartial>> grid_sources(const MosaicSources& sources,
                                                        const GridRequest& request,
                                                        const EffectRequest& effects,
                                                        pipeline::GeometryCache& geometries) {
    std::vector<pipeline::MadePartial> partials;
    for (const pipeline::SceneVolume& volume : sources.scene_volumes()) {
        const auto choice =
            pipeline::mosaic_choice(effects.chain, default_of(effects, sources.spec, volume.site));
        auto made = pipeline::make_partials(
            {&volume, 1}, sources.spec,
            pipeline::with_choice(partial_options(request, effects), choice), geometries);
        if (!made) return pass_on(made);
        partials.push_back(std::move(made->front()));
    }
    return partials;
}

Result<pipeline::MosaicScene> mosaic_scene(const MosaicSources& sources, const GridRequest& request,
                                           const grid::MosaicOptions& overlap,
                                           const EffectRequest& effects) {
    pipeline::MosaicSceneOptions options;
    options.frame = frame_options(request, overlap, effects);
    options.partial = partial_options(request, effects);
    options.instant = request.frame_time;
    return pipeline::MosaicScene::make(sources.scene_volumes(), sources.spec, effects.chain,
                                       options);
}

namespace {

Result<pipeline::MosaicFrame> frame_plainly(const MosaicSources& sources,
                                            const GridRequest& request,
                                            const grid::MosaicOptions& overlap,
                                            const EffectRequest& effects, MosaicTimings& timings) {
    Stopwatch watch;
    pipeline::GeometryCache geometries(mosaic_geometries);
    const auto partials = grid_sources(sources, request, effects, geometries);
    if (!partials) return pass_on(partials);
    timings.grid_s = watch.lap_s();
    const auto views = pipeline::views_of(*partials);
    const auto choice = pipeline::mosaic_choice(
        effects.chain, default_of(effects, sources.spec, sources.volumes.front().site));
    const UtcTime instant = request.frame_time.value_or(pipeline::instant_of_newest(views));
    auto frame = pipeline::make_frame(
        sources.spec, views, instant,
        pipeline::with_choice(frame_options(request, overlap, effects), choice), geometries);
    timings.merge_s = watch.lap_s();
    return frame;
}

// Returns none if the budget cannot be met.
Result<std::optional<pipeline::MosaicFrame>> frame_by_plan(const MosaicSources& sources,
                                                           const GridRequest& request,
                                                           const grid::MosaicOptions& overlap,
                                                           const EffectRequest& effects,
                                                           MadeMosaic& made) {
    Stopwatch watch;
    auto scene = mosaic_scene(sources, request, overlap, effects);
    if (!scene) return pass_on(scene);
    auto planned = pipeline::plan_mosaic(*scene, effects.chain, effects.budget);
    if (!planned) return pass_on(planned);
    made.plan = std::move(planned->plan);
    made.timings.plan_s = watch.lap_s();
    if (!made.plan->meets_budget) return std::optional<pipeline::MosaicFrame>{};
    if (auto gridded = scene->partials(planned->choice); !gridded) return pass_on(gridded);
    made.timings.grid_s = watch.lap_s();
    auto frame = scene->frame(planned->choice);
    if (!frame) return pass_on(frame);
    made.timings.merge_s = watch.lap_s();
    frame->description.provenance.predicted_error = grid::predicted_error(*made.plan);
    frame->description.provenance.effects = made.plan->description;
    return std::optional<pipeline::MosaicFrame>{std::move(*frame)};
}

}  // namespace

Result<MadeMosaic> make_mosaic(const std::vector<std::string>& files, const GridRequest& request,
                               const grid::MosaicOptions& overlap, const EffectRequest& effects) {
    const auto sources = load_mosaic(files, request);
    if (!sources) return pass_on(sources);
    MadeMosaic made;
    made.timings = sources->timings;
    std::optional<pipeline::MosaicFrame> frame;
    if (effects.needs_plan()) {
        auto planned = frame_by_plan(*sources, request, overlap, effects, made);
        if (!planned) return pass_on(planned);
        frame = std::move(*planned);
    } else {
        auto plain = frame_plainly(*sources, request, overlap, effects, made.timings);
        if (!plain) return pass_on(plain);
        frame = std::move(*plain);
    }
    if (!frame) return made;
    made.grid = dense_of(*frame);
    note_left_out(*sources, made.grid, made.grid.provenance.notes);
    return made;
}

}  // namespace stormcellar::cli
