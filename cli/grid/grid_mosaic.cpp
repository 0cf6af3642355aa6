#include "cli/grid/grid_mosaic.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "base/name_list.h"
#include "cli/shared/commands.h"
#include "cli/shared/progress.h"
#include "grid/place/site_extent.h"
#include "level2/decode/volume_checks.h"

namespace stormcellar::cli {
namespace {

// Returns the width and height in kilometers of the smallest grid of whole cells that holds all
// sites and 230 km around them.
std::array<double, 2> extent_km_of(const std::vector<grid::SitePosition>& sites,
                                   grid::GeoPoint center, double spacing_km) {
    const grid::HalfExtent half = grid::half_extent_of(sites, center);
    const auto whole = [&](double half_m) {
        const double cells = std::ceil((half_m + grid::seen_beyond_sites_m) / 1000 / spacing_km);
        return 2 * cells * spacing_km;
    };
    return {whole(half.x_m), whole(half.y_m)};
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

// Returns the names of the moments whose values must not be mixed between sites, as in "VEL and
// PHI".
std::string never_mixed() {
    std::vector<level2::MomentFacts> apart;
    for (const level2::MomentFacts& facts : level2::moment_facts) {
        if (grid::default_overlap(facts.moment) == grid::Overlap::nearest) apart.push_back(facts);
    }
    return names_in(apart, ", ", " and ");
}

}  // namespace

Result<grid::GridSpec> mosaic_spec(const std::vector<grid::SitePosition>& sites,
                                   GridRequest request) {
    if (sites.empty() && !request.center_deg) {
        return fail(ErrorCode::bad_argument,
                    "the position of none of the stations is known; give --center");
    }
    const grid::GeoPoint center =
        request.center_deg ? grid::GeoPoint{(*request.center_deg)[0], (*request.center_deg)[1]}
                           : grid::middle_of(sites);
    const bool in_km = request.extent_unit == SizeUnit::km && request.spacing_unit == SizeUnit::km;
    if (!request.extent_given && in_km && !sites.empty()) {
        request.extent = extent_km_of(sites, center, request.spacing);
    }
    return spec_about(request, center.latitude_deg, center.longitude_deg);
}

void add_mosaic_options(CLI::App& app, MosaicOptions& options, EffectOptions& effects) {
    app.add_option(
        "--overlap", options.overlap,
        fmt::format(
            "Rule for cells that several sites see: {} (the default). {} allow only nearest",
            names_in(grid::overlap_facts, ", ", " or "), never_mixed()));
    app.add_option(
        "--overlap-km", options.overlap_km,
        "Length L in km of the weight exp(-r^2/L^2) of a site at the distance r. Default: 250");
    app.add_option("--time-method", effects.time_method,
                   fmt::format("How to interpolate between two volumes of a site: {} (the default)",
                               names_in(grid::time_method_facts, ", ", " or ")));
}

Result<grid::MosaicOptions> parse_mosaic(const MosaicOptions& options, const EffectOptions& effects,
                                         std::size_t files, const GridRequest& request,
                                         level2::Moment moment) {
    grid::MosaicOptions mosaic;
    if (files == 1) {
        const std::string_view given = !options.overlap.empty()       ? "--overlap"
                                       : options.overlap_km           ? "--overlap-km"
                                       : !effects.time_method.empty() ? "--time-method"
                                                                      : "";
        if (given.empty()) return mosaic;
        return fail(ErrorCode::bad_argument, "{} needs several FILEs", given);
    }
    mosaic.moment = moment;
    mosaic.overlap = grid::default_overlap(moment);
    mosaic.threads = request.threads;
    mosaic.counts = request.site_counts;
    mosaic.weights = request.site_weights;
    if (!options.overlap.empty()) {
        const auto overlap = grid::overlap_from_name(options.overlap);
        if (!overlap) {
            return fail(ErrorCode::bad_argument, "--overlap takes one of {}, not '{}'",
                        names_in(grid::overlap_facts), options.overlap);
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

std::vector<pipeline::SceneVolume> MosaicSources::scene_volumes(level2::Moment moment) const {
    std::vector<pipeline::SceneVolume> all = scene_volumes();
    std::vector<pipeline::SceneVolume> holding;
    std::ranges::copy_if(all, std::back_inserter(holding),
                         [&](const auto& volume) { return level2::holds(*volume.volume, moment); });
    return holding.empty() ? all : holding;
}

std::size_t MosaicSources::site_count() const {
    return sites_of(volumes).size();
}

Result<MosaicSources> load_mosaic(const std::vector<std::string>& files,
                                  const GridRequest& request) {
    MosaicSources sources;
    Progress progress("files", files.size(), files.size() > 1);
    for (std::size_t i = 0; i < files.size(); ++i) {
        const std::string& file = files[i];
        progress.show(i);
        auto source = load_volume(file, request);
        if (!source && request.inputs && request.inputs->is_found(file) &&
            is_no_volume(source.error())) {
            progress.clear();
            print_note(fmt::format("left out: {}", source.error().message));
            continue;
        }
        if (!source) return pass_on(source);
        sources.files.push_back(file);
        sources.read_s += source->read_s;
        sources.decode_s += source->decode_s;
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

pipeline::MosaicRequest mosaic_request(const MosaicSources& sources, const GridRequest& request,
                                       const grid::MosaicOptions& overlap,
                                       const EffectRequest& effects) {
    pipeline::MosaicRequest mosaic;
    mosaic.domain = sources.spec;
    mosaic.chain = effects.chain;
    mosaic.frame.overlap = overlap;
    mosaic.frame.overlap.averaging = effects.averaging;
    mosaic.frame.threads = request.threads;
    mosaic.partial.gridder.moment = overlap.moment;
    mosaic.partial.gridder.threads = request.threads;
    mosaic.partial.gridder.profile = effects.profile;
    mosaic.instant = request.frame_time;
    mosaic.is_planned = effects.needs_plan();
    mosaic.budget = effects.budget;
    return mosaic;
}

}  // namespace stormcellar::cli
