#include "stormcellar/grid/gridder.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/floating_point.h"
#include "base/memory.h"
#include "grid/fill/column_filler.h"
#include "grid/fill/detail_filler.h"
#include "grid/sweep/polar_sweep.h"
#include "grid/sweep/sweep_clock.h"
#include "grid/sweep/sweep_stack.h"
#include "stormcellar/base/station_table.h"
#include "stormcellar/base/version.h"
#include "stormcellar/grid/beam_model.h"
#include "stormcellar/grid/column_geometry.h"
#include "stormcellar/grid/sweep_choice.h"

namespace stormcellar::grid {
namespace {

constexpr double wsr88d_beam_width_deg = 0.95;
constexpr double tdwr_beam_width_deg = 0.55;
constexpr double widest_beam_deg = 5.0;

void describe_times(const level2::Volume& volume, const std::vector<ChosenSweep>& chosen,
                    Grid& grid) {
    const std::optional<UtcTime> start = volume.start_time();
    std::optional<UtcTime> first, last;
    for (const ChosenSweep& sweep : chosen) {
        for (const std::uint32_t radial : sweep.radials) {
            const UtcTime time = volume.sweeps[sweep.sweep_index].radials[radial].time;
            if (!level2::is_time_of_volume(time, start)) continue;
            first = std::min(first.value_or(time), time);
            last = std::max(last.value_or(time), time);
        }
    }
    grid.time = start.value_or(UtcTime{});
    grid.start_time = first.value_or(grid.time);
    grid.end_time = last.value_or(grid.time);
}

// Returns a note that says how many sweeps of an elevation are equally good, and which of them is
// used.
std::string note_of_repeats(const ChosenSweep& sweep, std::optional<UtcTime> nearest_to) {
    const std::string rule =
        nearest_to ? fmt::format("the nearest to {}", format_utc(*nearest_to)) : "the newest";
    const std::string time =
        sweep.median_time ? fmt::format(", of {}", format_utc(*sweep.median_time)) : "";
    return fmt::format("{} sweeps at {:.1f} degrees: {} was taken{}", sweep.repeats,
                       sweep.fixed_angle_deg, rule, time);
}

void describe(const level2::Volume& volume, const SitePosition& site,
              const std::vector<ChosenSweep>& chosen, const GridderOptions& options,
              std::optional<UtcTime> nearest_to, Grid& grid) {
    describe_times(volume, chosen, grid);
    grid.frame_time = options.frame_time;
    grid.sites = {site};
    Provenance& provenance = grid.provenance;
    provenance.stations = {site.icao};
    provenance.method = options.method.name();
    provenance.beam_model = beam_model_of(site, options.method.beam, options.profile).name();
    provenance.averaging =
        options.method.averaging == Averaging::in_z ? "Z" : level2::moment_units(grid.moment);
    provenance.software_version = software_version;
    provenance.vcp = volume.vcp.value_or(0);
    provenance.sweeps = sweep_times(volume, chosen);
    for (const ChosenSweep& sweep : chosen) {
        const int cut = volume.sweeps[sweep.sweep_index].elevation_number;
        if (sweep.radials_off_elevation > 0) {
            provenance.notes.push_back(
                fmt::format("cut {}: {} radials left out, measured off its elevation of {:.2f} "
                            "degrees by more than half a beam",
                            cut, sweep.radials_off_elevation, sweep.elevation_deg));
        }
        if (sweep.repeats > 1) provenance.notes.push_back(note_of_repeats(sweep, nearest_to));
        if (!sweep.adjacent_to_next) {
            provenance.notes.push_back(fmt::format(
                "a cut of the VCP is missing above {:.2f} degrees", sweep.elevation_deg));
        }
    }
}

Status check(const SitePosition& site, const ColumnGeometry& geometry,
             const GridderOptions& options) {
    const SitePosition& made_for = geometry.site();
    const bool same_place =
        made_for.latitude_deg == site.latitude_deg && made_for.longitude_deg == site.longitude_deg;
    if (!same_place) {
        return fail(ErrorCode::bad_argument,
                    "the geometry was made for {} at {}, {}, not {} at {}, {}", made_for.icao,
                    made_for.latitude_deg, made_for.longitude_deg, site.icao, site.latitude_deg,
                    site.longitude_deg);
    }
    if (!is_within(site.altitude_m, -10000.0, 10000.0)) {
        return fail(ErrorCode::bad_argument, "{}: an antenna cannot stand at {} m", site.icao,
                    site.altitude_m);
    }
    if (!is_within(options.beam_width_deg, 0.0, widest_beam_deg)) {
        return fail(ErrorCode::bad_argument, "the beam width must be 0 to {} degrees, not {}",
                    widest_beam_deg, options.beam_width_deg);
    }
    if (options.method.averaging == Averaging::in_z && options.moment != level2::Moment::ref) {
        return fail(ErrorCode::bad_argument, "only reflectivity can be averaged in Z, not {}",
                    level2::moment_name(options.moment));
    }
    if (options.frame_time && !level2::is_plausible(*options.frame_time)) {
        return fail(ErrorCode::bad_argument, "no radar was at work at {}",
                    format_utc(*options.frame_time));
    }
    if (options.threads < 1) {
        return fail(ErrorCode::bad_argument, "threads must be at least 1, not {}", options.threads);
    }
    return {};
}

// Returns a time. Of repeated sweeps, the sweep nearest to this time is used. Returns none if the
// newest sweep is used.
std::optional<UtcTime> time_to_be_near(const level2::Volume& volume,
                                       const GridderOptions& options) {
    if (options.repeats == GridderOptions::Repeats::newest) return std::nullopt;
    return options.frame_time ? options.frame_time : volume.start_time();
}

// Returns the options with which the moment is gridded. Classes have no mean, so a cell has the
// class of the nearest gate of the nearest sweep, whatever the method asks for.
GridderOptions fitting_moment(GridderOptions options) {
    if (level2::facts_of(options.moment).is_categorical) {
        options.method.interpolation = Interpolation::nearest;
        options.method.cell = CellExtent::point;
    }
    return options;
}

double beam_width_deg(const SitePosition& site, const GridderOptions& options) {
    return options.beam_width_deg > 0 ? options.beam_width_deg : beam_width_of(site.icao);
}

}  // namespace

double beam_width_of(std::string_view icao) {
    return is_tdwr(icao) ? tdwr_beam_width_deg : wsr88d_beam_width_deg;
}

std::vector<ChosenSweep> sweeps_to_grid(const level2::Volume& volume, const SitePosition& site,
                                        const GridderOptions& options) {
    return choose_sweeps(volume, options.moment, beam_width_deg(site, options) / 2,
                         time_to_be_near(volume, options));
}

Result<Grid> make_grid(const level2::Volume& volume, const SitePosition& site,
                       const ColumnGeometry& geometry, const GridderOptions& asked) {
    const GridderOptions options = fitting_moment(asked);
    if (auto good = check(site, geometry, options); !good) return pass_on(good);
    const std::vector<ChosenSweep> chosen = sweeps_to_grid(volume, site, options);
    if (chosen.empty()) {
        return fail(ErrorCode::not_found, "the volume has no sweep with {}",
                    level2::moment_name(options.moment));
    }

    Grid grid;
    grid.spec = geometry.spec();
    grid.moment = options.moment;
    grid.values = zeros_in_large_pages<float>(grid.spec.cell_count());
    grid.status = zeros_in_large_pages<CellStatus>(grid.spec.cell_count());
    describe(volume, site, chosen, options, time_to_be_near(volume, options), grid);
    const SweepStack stack = make_stack(
        volume, site, chosen,
        {options.moment, beam_width_deg(site, options), options.method, options.profile});
    fill_grid(stack, geometry, geometry.tiles(), options.method, options.threads, grid);
    if (options.details.any()) {
        fill_details({volume, chosen, stack,
                      beam_model_of(site, options.method.beam, options.profile), geometry, options},
                     grid);
    }
    return grid;
}

}  // namespace stormcellar::grid
