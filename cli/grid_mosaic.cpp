#include "cli/grid_mosaic.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <CLI/CLI.hpp>

#include "cli/stopwatch.h"
#include "cli/volume_source.h"
#include "grid/effects.h"
#include "grid/projection.h"
#include "grid/site_frame.h"

namespace stormcellar::cli {
namespace {

constexpr double beyond_sites_m = 230'000;  // what a mosaic shows about its outermost sites

// The middle of the box that holds the sites, by the shorter way round the earth.
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

// Whole cells that hold all sites and 230 km about them, in kilometres.
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

Result<grid::GridSpec> spec_of(const std::vector<grid::SitePosition>& sites, GridRequest request) {
    const auto center = request.center_deg.value_or(middle_of(sites));
    const bool in_km = request.extent_unit == SizeUnit::km && request.spacing_unit == SizeUnit::km;
    if (!request.extent_given && in_km) {
        request.extent = extent_km_of(sites, center, request.spacing);
    }
    return spec_about(request, center[0], center[1]);
}

// The middle of the newest volumes' middles, the earliest and the latest of them counting.
UtcTime instant_of(const std::vector<pipeline::PartialView>& partials) {
    std::map<std::string, UtcTime> newest;
    for (const pipeline::PartialView& partial : partials) {
        UtcTime& time = newest[partial.site().icao];
        time = std::max(time, partial.middle());
    }
    const auto [first, last] =
        std::minmax_element(newest.begin(), newest.end(),
                            [](const auto& a, const auto& b) { return a.second < b.second; });
    return first->second + (last->second - first->second) / 2;
}

pipeline::PartialOptions partial_options(const GridRequest& request, const EffectRequest& effects,
                                         const grid::GridSpec& spec,
                                         const grid::SitePosition& site) {
    const accuracy::Choice rungs =
        grid::default_choice(effects.chain, spec, grid::beam_width_of(site.icao));
    pipeline::PartialOptions options;
    options.gridder.moment = request.moment;
    options.gridder.threads = request.threads;
    options.gridder.method = grid::scene_choice(effects.chain, rungs).method;
    options.gridder.profile = effects.profile;
    options.quantization = grid::default_quantization(request.moment);
    return options;
}

Result<std::vector<SourceVolume>> load_all(const std::vector<std::string>& files,
                                           const GridRequest& request, MosaicTimings& timings) {
    std::vector<SourceVolume> sources;
    for (const std::string& file : files) {
        auto source = load_volume(file, request.moment, request.threads);
        if (!source) return pass_on(source);
        timings.read_s += source->read_s;
        timings.decode_s += source->decode_s;
        sources.push_back(std::move(*source));
    }
    return sources;
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

Result<std::vector<pipeline::MadePartial>> grid_all(const std::vector<std::string>& files,
                                                    const std::vector<SourceVolume>& sources,
                                                    const grid::GridSpec& spec,
                                                    const GridRequest& request,
                                                    const EffectRequest& effects,
                                                    pipeline::GeometryCache& geometries) {
    std::vector<pipeline::MadePartial> partials;
    for (std::size_t at = 0; at < sources.size(); ++at) {
        const grid::SitePosition& site = sources[at].site;
        auto made =
            pipeline::make_partial(sources[at].volume, site, spec,
                                   partial_options(request, effects, spec, site), geometries);
        if (!made) return fail(made.error().code, "{}: {}", files[at], made.error().message);
        if (!*made) {
            return fail(ErrorCode::bad_argument, "{}: {} sees nothing of the grid", files[at],
                        site.icao);
        }
        grid::Provenance& provenance = (*made)->description.provenance;
        provenance.source_files = {std::filesystem::path(files[at]).filename().string()};
        provenance.partial = sources[at].partial;
        provenance.notes.insert(provenance.notes.begin(), sources[at].notes.begin(),
                                sources[at].notes.end());
        for (std::string& note : provenance.notes)
            note = fmt::format("{}: {}", site.icao, note);
        partials.push_back(std::move(**made));
    }
    return partials;
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
    // Where no site sees a cell both are 0, as to_dense() leaves what has no value.
    if (frame.mosaic.counts) {
        const grid::Grid counts = grid::to_dense(frame.mosaic.counts->view());
        grid.site_counts.assign(counts.values.begin(), counts.values.end());
    }
    if (frame.mosaic.weights) {
        grid.site_weights = std::move(grid::to_dense(frame.mosaic.weights->view()).values);
    }
    return grid;
}

// Sites whose volumes are all too far from the instant.
void note_missing(const std::vector<grid::SitePosition>& sites, const grid::Grid& grid,
                  std::vector<std::string>& notes) {
    for (const grid::SitePosition& site : sites) {
        const auto is_it = [&](const grid::SitePosition& used) { return used.icao == site.icao; };
        if (std::any_of(grid.sites.begin(), grid.sites.end(), is_it)) continue;
        notes.push_back(fmt::format("{}: no volume within 15 minutes of {}, so it is left out",
                                    site.icao, format_utc(grid.time)));
    }
}

}  // namespace

void add_mosaic_options(CLI::App& app, MosaicOptions& options) {
    app.add_option("--overlap", options.overlap,
                   "Where several sites see a cell: distance-weighted (the default), mean, maximum "
                   "or nearest (all that VEL and PHI allow)");
    app.add_option("--overlap-km", options.overlap_km,
                   "L of the weight exp(-r^2/L^2) of a site r away; else 250");
    app.add_option("--time-method", options.time_method,
                   "Between two volumes of a site: advected (the default), blend or nearest");
}

Result<MosaicRequest> parse_mosaic(const MosaicOptions& options, std::size_t files,
                                   const GridRequest& request, const EffectRequest& effects) {
    MosaicRequest mosaic;
    if (files == 1) {
        const std::string_view given = !options.overlap.empty()       ? "--overlap"
                                       : options.overlap_km           ? "--overlap-km"
                                       : !options.time_method.empty() ? "--time-method"
                                                                      : "";
        if (given.empty()) return mosaic;
        return fail(ErrorCode::bad_argument, "{} is for several FILEs", given);
    }
    mosaic.overlap.moment = request.moment;
    mosaic.overlap.overlap = grid::default_overlap(request.moment);
    mosaic.overlap.averaging = effects.averaging;
    mosaic.overlap.threads = request.threads;
    mosaic.overlap.counts = request.site_counts;
    mosaic.overlap.weights = request.site_weights;
    if (!options.overlap.empty()) {
        const auto overlap = grid::overlap_from_name(options.overlap);
        if (!overlap) {
            return fail(ErrorCode::bad_argument,
                        "--overlap takes one of distance-weighted, mean, maximum, nearest, not "
                        "'{}'",
                        options.overlap);
        }
        mosaic.overlap.overlap = *overlap;
    }
    if (options.overlap_km) {
        if (!(*options.overlap_km >= 1 && *options.overlap_km <= 10'000)) {
            return fail(ErrorCode::bad_argument, "--overlap-km must be 1 to 10000, not {}",
                        *options.overlap_km);
        }
        mosaic.overlap.length_m = *options.overlap_km * 1000;
    }
    if (!options.time_method.empty()) {
        const auto method = grid::time_method_from_name(options.time_method);
        if (!method) {
            return fail(ErrorCode::bad_argument,
                        "--time-method takes one of advected, blend, nearest, not '{}'",
                        options.time_method);
        }
        mosaic.time = *method;
    }
    return mosaic;
}

std::vector<pipeline::PartialView> MosaicParts::views() const {
    std::vector<pipeline::PartialView> views;
    for (const pipeline::MadePartial& partial : partials)
        views.push_back({&partial.description, partial.bricks.view()});
    return views;
}

Result<MosaicParts> make_parts(const std::vector<std::string>& files, const GridRequest& request,
                               const EffectRequest& effects, pipeline::GeometryCache& geometries) {
    MosaicParts parts;
    const auto sources = load_all(files, request, parts.timings);
    if (!sources) return pass_on(sources);
    parts.sites = sites_of(*sources);
    auto spec = spec_of(parts.sites, request);
    if (!spec) return pass_on(spec);
    parts.spec = std::move(*spec);
    Stopwatch watch;
    auto partials = grid_all(files, *sources, parts.spec, request, effects, geometries);
    if (!partials) return pass_on(partials);
    parts.partials = std::move(*partials);
    parts.timings.grid_s = watch.lap_s();
    parts.instant = request.frame_time.value_or(instant_of(parts.views()));
    return parts;
}

Result<MadeMosaic> make_mosaic(const std::vector<std::string>& files, const GridRequest& request,
                               const MosaicRequest& mosaic, const EffectRequest& effects) {
    pipeline::GeometryCache geometries(mosaic_geometries);
    const auto parts = make_parts(files, request, effects, geometries);
    if (!parts) return pass_on(parts);
    MadeMosaic made;
    made.timings = parts->timings;
    Stopwatch watch;
    pipeline::FrameOptions options;
    options.overlap = mosaic.overlap;
    options.time = mosaic.time;
    options.threads = request.threads;
    if (!request.frame_time) options.greatest_gap = std::chrono::hours{24 * 365 * 100};
    const auto frame =
        pipeline::make_frame(parts->spec, parts->views(), parts->instant, options, geometries);
    if (!frame) return pass_on(frame);
    made.grid = dense_of(*frame);
    note_missing(parts->sites, made.grid, made.grid.provenance.notes);
    made.timings.merge_s = watch.lap_s();
    return made;
}

}  // namespace stormcellar::cli
