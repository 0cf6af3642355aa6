#include "grid/gridder.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/parallel.h"
#include "base/station_table.h"
#include "base/version.h"
#include "grid/beam_geometry.h"
#include "grid/column.h"
#include "grid/column_geometry.h"
#include "grid/polar_sweep.h"
#include "grid/sweep_choice.h"

namespace stormcellar::grid {
namespace {

constexpr double wsr88d_beam_width_deg = 0.95;
constexpr double tdwr_beam_width_deg = 0.55;
constexpr double widest_beam_deg = 5;
constexpr double farthest_arc_m = 1e6;  // no radar sees farther; bounds the tables

bool is_tdwr(std::string_view icao) {
    const auto station = find_station(icao);
    return station && station->kind == RadarKind::tdwr;
}

// Fills the rows of a grid; shared by the threads.
class RowFiller {
  public:
    RowFiller(Grid& grid, const ColumnGeometry& geometry, std::vector<PolarSweep> sweeps,
              const std::vector<ChosenSweep>& chosen, std::size_t table_size)
        : grid_(grid),
          geometry_(geometry),
          sweeps_(std::move(sweeps)),
          chosen_(chosen),
          table_end_(static_cast<float>(table_size - 1)),
          blending_(blending_of(grid.moment)) {
        for (const double level_m : grid.spec.levels_m)
            levels_m_.push_back(static_cast<float>(level_m));
        for (std::size_t i = 0; i < chosen.size(); ++i) {
            const bool lowest = i == 0 || !chosen[i - 1].adjacent_to_next;
            const bool highest = i + 1 == chosen.size() || !chosen[i].adjacent_to_next;
            edges_matter_.push_back(lowest || highest);
        }
    }

    void run(int threads) {
        for_each_piece(grid_.spec.ny, threads, [this](int iy) { fill_row(iy); });
    }

  private:
    void fill_row(int iy) {
        std::vector<BeamSample> beams(sweeps_.size());
        std::size_t first_cell = grid_.spec.index(0, iy, 0);
        for (const ColumnPlace& place : geometry_.row(iy)) {
            fill_one(place, first_cell, beams);
            first_cell += levels_m_.size();
        }
    }

    void fill_one(const ColumnPlace& column, std::size_t first_cell,
                  std::vector<BeamSample>& beams) {
        const float along = column.arc_m / static_cast<float>(ArcTable::step_m);
        if (!(along < table_end_)) return;  // beyond every gate: not seen, as the grid began
        ArcPlace place;
        place.index = static_cast<std::size_t>(along);
        place.fraction = along - static_cast<float>(place.index);
        const std::size_t count = sample_beams(column.azimuth_deg, place, beams);
        fill_column(std::span(beams).first(count), levels_m_, blending_,
                    std::span(grid_.status).subspan(first_cell, levels_m_.size()),
                    std::span(grid_.values).subspan(first_cell, levels_m_.size()));
    }

    // Beams from the lowest up to the first above the top level, which is the last that matters.
    std::size_t sample_beams(float azimuth_deg, ArcPlace place,
                             std::vector<BeamSample>& beams) const {
        std::size_t count = 0;
        bool below_top = true;
        while (count < sweeps_.size() && below_top) {
            const PolarSweep& sweep = sweeps_[count];
            BeamSample& beam = beams[count];
            beam.sample = sweep.sample(azimuth_deg, place);
            beam.height_m = sweep.beam_height_m(place);
            beam.adjacent_to_next = chosen_[count].adjacent_to_next;
            if (edges_matter_[count]) {
                beam.lower_edge_m = sweep.lower_edge_m(place);
                beam.upper_edge_m = sweep.upper_edge_m(place);
            }
            below_top = beam.height_m <= levels_m_.back();
            ++count;
        }
        return count;
    }

    Grid& grid_;
    const ColumnGeometry& geometry_;
    const std::vector<PolarSweep> sweeps_;
    const std::vector<ChosenSweep>& chosen_;
    const float table_end_;
    const Blending blending_;
    std::vector<float> levels_m_;
    std::vector<bool> edges_matter_;  // of each sweep: it has no neighbour above or below
};

void describe_times(const level2::Volume& volume, const std::vector<ChosenSweep>& chosen,
                    Grid& grid) {
    std::optional<UtcTime> first, last;
    for (const ChosenSweep& sweep : chosen) {
        for (const std::uint32_t radial : sweep.radials) {
            const UtcTime time = volume.sweeps[sweep.sweep_index].radials[radial].time;
            if (!level2::is_plausible(time)) continue;
            first = std::min(first.value_or(time), time);
            last = std::max(last.value_or(time), time);
        }
    }
    grid.time = volume.start_time().value_or(UtcTime{});
    grid.start_time = first.value_or(grid.time);
    grid.end_time = last.value_or(grid.time);
}

void describe(const level2::Volume& volume, const SitePosition& site,
              const std::vector<ChosenSweep>& chosen, Grid& grid) {
    describe_times(volume, chosen, grid);
    grid.sites = {site};
    Provenance& provenance = grid.provenance;
    provenance.stations = {site.icao};
    provenance.method =
        blending_of(grid.moment) == Blending::nearest ? "column-nearest" : "column-linear";
    provenance.beam_model = "4/3 earth";
    provenance.averaging = level2::moment_units(grid.moment);
    provenance.software_version = software_version;
    provenance.vcp = volume.vcp.value_or(0);
    for (const ChosenSweep& sweep : chosen) {
        const int cut = volume.sweeps[sweep.sweep_index].elevation_number;
        if (sweep.radials_off_elevation > 0) {
            provenance.notes.push_back(
                fmt::format("cut {}: {} radials left out, measured off its elevation of {:.2f} "
                            "degrees by more than half a beam",
                            cut, sweep.radials_off_elevation, sweep.elevation_deg));
        }
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
    if (!(std::abs(site.altitude_m) <= 10000)) {
        return fail(ErrorCode::bad_argument, "{}: an antenna does not stand at {} m", site.icao,
                    site.altitude_m);
    }
    if (!(options.beam_width_deg >= 0 && options.beam_width_deg <= widest_beam_deg)) {
        return fail(ErrorCode::bad_argument, "the beam width must be 0 to {} degrees, not {}",
                    widest_beam_deg, options.beam_width_deg);
    }
    if (options.threads < 1) {
        return fail(ErrorCode::bad_argument, "threads must be at least 1, not {}", options.threads);
    }
    return {};
}

}  // namespace

double beam_width_of(std::string_view icao) {
    return is_tdwr(icao) ? tdwr_beam_width_deg : wsr88d_beam_width_deg;
}

Result<Grid> make_grid(const level2::Volume& volume, const SitePosition& site,
                       const ColumnGeometry& geometry, const GridderOptions& options) {
    if (auto good = check(site, geometry, options); !good) return pass_on(good);
    const double beam_width_deg =
        options.beam_width_deg > 0 ? options.beam_width_deg : beam_width_of(site.icao);
    const std::vector<ChosenSweep> chosen =
        choose_sweeps(volume, options.moment, beam_width_deg / 2);
    if (chosen.empty()) {
        return fail(ErrorCode::not_found, "the volume has no sweep with {}",
                    level2::moment_name(options.moment));
    }

    const BeamGeometry beam(site.latitude_deg, site.altitude_m);
    double farthest_m = 0;
    for (const ChosenSweep& sweep : chosen) {
        farthest_m = std::max(farthest_m, greatest_arc_m(volume.sweeps[sweep.sweep_index], sweep,
                                                         options.moment, beam));
    }
    PolarSweepOptions sweep_options{options.moment, beam_width_deg / 2, is_tdwr(site.icao), 2};
    sweep_options.table_size +=
        static_cast<std::size_t>(std::min(farthest_m, farthest_arc_m) / ArcTable::step_m);
    std::vector<PolarSweep> sweeps;
    sweeps.reserve(chosen.size());
    for (const ChosenSweep& sweep : chosen)
        sweeps.emplace_back(volume.sweeps[sweep.sweep_index], sweep, beam, sweep_options);

    Grid grid;
    grid.spec = geometry.spec();
    grid.moment = options.moment;
    grid.values.resize(grid.spec.cell_count());
    grid.status.resize(grid.spec.cell_count());
    describe(volume, site, chosen, grid);
    RowFiller(grid, geometry, std::move(sweeps), chosen, sweep_options.table_size)
        .run(options.threads);
    return grid;
}

}  // namespace stormcellar::grid
