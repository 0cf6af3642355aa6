#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "capi/grid_handle.h"
#include "grid/place/site_extent.h"
#include "grid/plan/grid_effects.h"
#include "grid/plan/position_error.h"
#include "pipeline/mosaic/mosaic_effects.h"

namespace stormcellar::capi {
namespace {

// Returns how many whole cells hold the sites and the air that the sites see around them.
int cells_beyond(double half_extent_m, double spacing_m) {
    const double cells = 2 * std::ceil((half_extent_m + grid::seen_beyond_sites_m) / spacing_m);
    constexpr auto most = static_cast<double>(std::numeric_limits<int>::max());
    return cells <= most ? static_cast<int>(cells) : std::numeric_limits<int>::max();
}

// Sets the step to this rung, whatever a chooser would choose.
void fix(accuracy::Chain& chain, std::string_view step, std::size_t rung) {
    const auto found = accuracy::find_step(chain, step);
    if (!found) return;
    auto& effects = chain.steps[*found].effects;
    for (std::size_t i = 0; i < effects.size(); ++i)
        effects[i].setting = i < rung ? accuracy::Setting::on : accuracy::Setting::off;
}

}  // namespace

Result<grid::SitePosition> site_of(const stormcellar_volume& volume) {
    const auto antenna = level2::antenna_position(volume.source.volume);
    if (!antenna)
        return fail(ErrorCode::not_found, "the position of the radar is unknown; name the station");
    return grid::SitePosition{volume.source.volume.station, antenna->latitude_deg,
                              antenna->longitude_deg, antenna->altitude_m};
}

Result<grid::GridSpec> spec_of(const stormcellar_grid_options& options,
                               const std::vector<grid::SitePosition>& sites) {
    const grid::GeoPoint center =
        options.has_center != 0
            ? grid::GeoPoint{options.center_latitude_deg, options.center_longitude_deg}
            : grid::middle_of(sites);
    grid::GridSpec spec = grid::default_spec(center.latitude_deg, center.longitude_deg);
    if (options.spacing_m != 0) spec.spacing_m = options.spacing_m;
    if (Status valid = grid::validate(spec); !valid) return pass_on(valid);
    if (sites.size() > 1) {
        const grid::HalfExtent half = grid::half_extent_of(sites, center);
        spec.nx = cells_beyond(half.x_m, spec.spacing_m);
        spec.ny = cells_beyond(half.y_m, spec.spacing_m);
    }
    if (options.columns != 0) spec.nx = options.columns;
    if (options.rows != 0) spec.ny = options.rows;
    if (options.level_count < 0 || (options.level_count > 0 && options.levels_m == nullptr))
        return fail(ErrorCode::bad_argument, "level_count is {}, and levels_m is {}",
                    options.level_count, options.levels_m == nullptr ? "null" : "given");
    if (options.level_count > 0)
        spec.levels_m.assign(options.levels_m, options.levels_m + options.level_count);
    if (Status valid = grid::validate(spec); !valid) return pass_on(valid);
    return spec;
}

Result<grid::GridderOptions> gridder_of(const stormcellar_grid_options& options) {
    grid::GridderOptions gridder;
    if (options.moment != nullptr) {
        const auto moment = level2::moment_from_name(options.moment);
        if (!moment)
            return fail(ErrorCode::bad_argument, "there is no moment '{}'", options.moment);
        gridder.moment = *moment;
    }
    if (options.threads < 0) return fail(ErrorCode::bad_argument, "threads must be at least 0");
    gridder.threads = std::max(1, options.threads);
    return gridder;
}

Result<VolumeGridding> gridding_of(const stormcellar_grid_options& options,
                                   const stormcellar_volume& volume) {
    const auto site = site_of(volume);
    if (!site) return pass_on(site);
    auto spec = spec_of(options, {*site});
    if (!spec) return pass_on(spec);
    const auto gridder = gridder_of(options);
    if (!gridder) return pass_on(gridder);
    return VolumeGridding{*site, std::move(*spec), *gridder};
}

Result<accuracy::Chain> chain_of(const stormcellar_grid_options& options, level2::Moment moment,
                                 std::optional<grid::Overlap> overlap) {
    const auto averaging =
        options.average_in_z != 0 ? grid::Averaging::in_z : grid::Averaging::in_db;
    accuracy::Chain chain = overlap ? pipeline::mosaic_effects_of(moment, averaging, *overlap)
                                    : grid::effects_of(moment, averaging);
    fix(chain, grid::step::cell, options.mean_of_cell != 0 ? 1 : 0);
    if (options.interpolation == nullptr) return chain;
    const auto row = std::ranges::find(grid::interpolation_facts, options.interpolation,
                                       &grid::InterpolationFacts::name);
    if (row == grid::interpolation_facts.end())
        return fail(ErrorCode::bad_argument,
                    "interpolation is '{}'; it must be nearest, linear, eight-point or "
                    "beam-weighted",
                    options.interpolation);
    fix(chain, grid::step::interpolation, static_cast<std::size_t>(row->interpolation));
    return chain;
}

Result<grid::Grid> grid_of(const stormcellar_volume& volume, const grid::SitePosition& site,
                           const grid::GridSpec& spec, const accuracy::Chain& chain,
                           grid::GridderOptions gridder) {
    const grid::SourceVolume& source = volume.source;
    const accuracy::Choice rungs =
        grid::default_choice(chain, spec, grid::beam_width_of(site.icao));
    const grid::SceneChoice choice = grid::scene_choice(chain, rungs);
    const auto geometry = grid::make_column_geometry(site, spec, choice.frame);
    if (!geometry) return pass_on(geometry);
    gridder.method = choice.method;
    auto made = grid::make_grid(source.volume, site, **geometry, gridder);
    if (!made) return pass_on(made);
    grid::Provenance& provenance = made->provenance;
    provenance.effects = accuracy::describe(chain, rungs);
    provenance.predicted_error =
        grid::unplanned_error(source.volume, site, spec, choice.frame, gridder);
    provenance.source_files = {volume.file};
    provenance.partial = source.partial;
    provenance.notes.insert(provenance.notes.begin(), source.notes.begin(), source.notes.end());
    provenance.radar_troubles = source.radar_troubles;
    return made;
}

}  // namespace stormcellar::capi
