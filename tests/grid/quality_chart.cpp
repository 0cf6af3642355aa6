#include "tests/grid/quality_chart.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "stormcellar/grid/projection.h"
#include "stormcellar/grid/site_frame.h"
#include "synth/observe.h"
#include "synth/truth.h"

namespace stormcellar::grid {
namespace {

using grid::CellStatus;

constexpr double azimuth_deg = 40.2;  // no radial's azimuth, and not along an axis of a grid
constexpr double cell_m = 1000;
constexpr double level_m = 500;
constexpr double plateau_dbz = 40;
constexpr double wave_db = 10;
constexpr double echo_dbz = 20;
constexpr double half_power_widths = 2.3548;  // width of a Gaussian in standard deviations
constexpr std::array<double, 4> shifts_m = {-370, -110, 160, 430};

struct Along {
    double east = std::sin(azimuth_deg * std::numbers::pi / 180);
    double north = std::cos(azimuth_deg * std::numbers::pi / 180);
};

double z_of(double dbz) {
    return std::pow(10.0, dbz / 10);
}

synth::Scene scene_of(Gates gates) {
    synth::Scene scene;
    scene.site = {"KTLX", 35.3333, -97.2778, 390};
    scene.schedule.start = time_from_nexrad(19876, 0);
    scene.schedule.pattern = *synth::find_pattern(212);
    if (gates == Gates::of_beams) {
        scene.instrument.beam_width_deg = 0.95;
        scene.instrument.pulse_length_m = 470;
    }
    return scene;
}

Observed observed(synth::Scene scene, double range_m) {
    Observed made{std::move(scene), {}, range_m};
    made.volume = synth::observe(made.scene, 0);
    return made;
}

synth::Footprint footprint_at(double range_m, double along_m, double across_m) {
    const Along along;
    synth::Footprint footprint;
    footprint.x_m = range_m * along.east;
    footprint.y_m = range_m * along.north;
    footprint.major_m = along_m;
    footprint.minor_m = across_m;
    footprint.orientation_deg = azimuth_deg;
    return footprint;
}

// Makes a grid about the place `ahead_m` beyond the feature, with its lattice shifted by `shift_m`.
grid::Grid grid_about(const Observed& given, const grid::Method& method, double ahead_m, int side,
                      double shift_m) {
    const synth::Site& at = given.scene.site;
    const grid::SitePosition site{at.station, at.latitude_deg, at.longitude_deg,
                                  static_cast<double>(at.antenna_altitude_m)};
    const Along along;
    const double range_m = given.range_m + ahead_m;
    const grid::GeoPoint center =
        grid::SiteFrame(site.latitude_deg, site.longitude_deg)
            .to_geo(grid::SiteFrame::from_plane(range_m * along.east + shift_m,
                                                range_m * along.north - shift_m / 2));
    grid::GridSpec spec = grid::default_spec(center.latitude_deg, center.longitude_deg);
    spec.nx = spec.ny = side;
    spec.spacing_m = cell_m;
    const auto geometry = grid::make_column_geometry(site, spec);
    if (!geometry) return {};
    grid::GridderOptions options{.method = method};
    auto made = grid::make_grid(given.volume, site, **geometry, options);
    return made ? std::move(*made) : grid::Grid{};
}

// A column's place in the plane of the scene, and its distances from the feature along and across
// the beam.
struct Place {
    double x_m = 0, y_m = 0, along_m = 0, across_m = 0;
};

class Places {
  public:
    Places(const Observed& given, const grid::Grid& grid)
        : given_(given),
          projection_(grid.spec),
          frame_(given.scene.site.latitude_deg, given.scene.site.longitude_deg) {}
    [[nodiscard]] Place at(double ix, double iy) const {
        const grid::PlanePoint plane =
            grid::SiteFrame::to_plane(frame_.to_polar(projection_.to_geo({ix, iy})));
        const Along along;
        const double ahead_m = plane.x_m * along.east + plane.y_m * along.north - given_.range_m;
        const double aside_m = plane.x_m * along.north - plane.y_m * along.east;
        return {plane.x_m, plane.y_m, ahead_m, aside_m};
    }

  private:
    const Observed& given_;
    grid::GridProjection projection_;
    grid::SiteFrame frame_;
};

// Sums over cells: of Z, of Z times a distance from the feature, and of Z times the squared
// distance.
struct Moments {
    double sum = 0;
    std::array<double, 3> first{}, second{};  // along, across, up; km

    void add(const Place& place, double height_m, double z) {
        const std::array<double, 3> at = {place.along_m / 1000, place.across_m / 1000,
                                          height_m / 1000};
        sum += z;
        for (std::size_t i = 0; i < 3; ++i) {
            first[i] += z * at[i];
            second[i] += z * at[i] * at[i];
        }
    }
    [[nodiscard]] double mean(std::size_t i) const { return first[i] / sum; }
    [[nodiscard]] double width(std::size_t i) const {
        return half_power_widths * std::sqrt(std::max(0.0, second[i] / sum - mean(i) * mean(i)));
    }
};

struct PointSums {
    Moments grid, truth;
    double echo_cells = 0, true_echo_cells = 0;
    double peak_dbz = -100;
};

// The true value of a cell is the mean over 4 x 4 x 4 points.
constexpr int parts = 4;

double offset(int part) {
    return (part + 0.5) / parts - 0.5;
}

std::vector<Place> parts_of_column(const Places& places, int ix, int iy) {
    std::vector<Place> made;
    for (int i = 0; i < parts; ++i) {
        for (int j = 0; j < parts; ++j)
            made.push_back(places.at(ix + offset(i), iy + offset(j)));
    }
    return made;
}

void add_truth(const Observed& given, const std::vector<Place>& column, double height_m,
               PointSums& sums) {
    constexpr double share = 1.0 / (parts * parts * parts);
    for (const Place& place : column) {
        for (int k = 0; k < parts; ++k) {
            const double z_m = height_m + level_m * offset(k);
            const synth::Point point{place.x_m, place.y_m, z_m};
            const double z = synth::linear_truth(given.scene.weather, point, 0).z_mm6_m3;
            sums.truth.add(place, z_m, z * share);
            if (z >= z_of(echo_dbz)) sums.true_echo_cells += share;
        }
    }
}

// Calls visit(ix, iy, place) for each column of the grid.
template <class Visit>
void for_each_column(const Observed& given, const grid::Grid& made, Visit visit) {
    const Places places(given, made);
    for (int iy = 0; iy < made.spec.ny; ++iy) {
        for (int ix = 0; ix < made.spec.nx; ++ix)
            visit(ix, iy, places.at(ix, iy));
    }
}

PointSums point_sums(const Observed& given, const grid::Method& method, double shift_m) {
    const grid::Grid made = grid_about(given, method, 0, 25, shift_m);
    const Places places(given, made);
    PointSums sums;
    for (int iy = 0; iy < made.spec.ny; ++iy) {
        for (int ix = 0; ix < made.spec.nx; ++ix) {
            const Place place = places.at(ix, iy);
            const std::vector<Place> column = parts_of_column(places, ix, iy);
            for (int level = 0; level < made.spec.nz(); ++level) {
                const std::size_t cell = made.spec.index(ix, iy, level);
                if (made.status[cell] == CellStatus::not_seen) continue;
                const double height_m = made.spec.levels_m[static_cast<std::size_t>(level)];
                add_truth(given, column, height_m, sums);
                if (made.status[cell] != CellStatus::value) continue;
                const auto dbz = static_cast<double>(made.values[cell]);
                sums.grid.add(place, height_m, z_of(dbz));
                sums.peak_dbz = std::max(sums.peak_dbz, dbz);
                if (dbz >= echo_dbz) ++sums.echo_cells;
            }
        }
    }
    return sums;
}

}  // namespace

Observed observe_point(double range_m, Gates gates) {
    synth::Scene scene = scene_of(gates);
    synth::Storm storm;
    storm.footprint = footprint_at(range_m, 2000, 2000);  // at its edge 40 dB below the peak
    storm.peak_dbz = 50;
    scene.weather.storms.push_back(storm);
    return observed(std::move(scene), range_m);
}

Observed observe_edge(double range_m, Gates gates) {
    constexpr double half_m = 20e3;
    synth::Scene scene = scene_of(gates);
    synth::Box box;
    box.footprint = footprint_at(range_m + half_m, half_m, half_m);
    box.top_m = 14000;
    box.peak_dbz = plateau_dbz;
    box.edge_m = 50;
    scene.weather.boxes.push_back(box);
    return observed(std::move(scene), range_m);
}

Observed observe_wave(double range_m, Gates gates, double length_m, bool across) {
    synth::Scene scene = scene_of(gates);
    synth::Box box;
    box.footprint = footprint_at(range_m, 20e3, 20e3);
    box.top_m = 14000;
    box.peak_dbz = 30;
    box.wave = {wave_db, length_m, azimuth_deg + (across ? 90 : 0)};
    scene.weather.boxes.push_back(box);
    return observed(std::move(scene), range_m);
}

PointChart point_chart(const Observed& given, const grid::Method& method) {
    PointChart chart;
    double square_km2 = 0;
    constexpr auto count = static_cast<double>(shifts_m.size());
    for (const double shift_m : shifts_m) {
        const PointSums sums = point_sums(given, method, shift_m);
        const Moments& made = sums.grid;
        const Moments& truth = sums.truth;
        chart.along_km += made.width(0) / count;
        chart.across_km += made.width(1) / count;
        chart.height_km += made.width(2) / count;
        chart.true_along_km += truth.width(0) / count;
        chart.true_across_km += truth.width(1) / count;
        chart.true_height_km += truth.width(2) / count;
        const double along_km = made.mean(0) - truth.mean(0);
        const double across_km = made.mean(1) - truth.mean(1);
        square_km2 += (along_km * along_km + across_km * across_km) / count;
        chart.shift_height_km += (made.mean(2) - truth.mean(2)) / count;
        chart.peak_dbz = std::max(chart.peak_dbz, sums.peak_dbz);
        chart.total_z_ratio += made.sum / truth.sum / count;
        chart.echo_volume_ratio += sums.echo_cells / sums.true_echo_cells / count;
    }
    chart.shift_km = std::sqrt(square_km2);
    return chart;
}

EdgeChart edge_chart(const Observed& given, const grid::Method& method) {
    // Finds, for each distance from the edge, how large Z is on average as a share of the plateau's
    // Z. Bins are 125 m wide.
    constexpr double reach_m = 8000;
    constexpr double bin_m = 125;
    constexpr auto bins = static_cast<std::size_t>(2 * reach_m / bin_m);
    std::array<double, bins> sums{}, counts{};
    for (const double shift_m : shifts_m) {
        const grid::Grid made = grid_about(given, method, 0, 41, shift_m);
        for_each_column(given, made, [&](int ix, int iy, const Place& place) {
            if (std::abs(place.along_m) >= reach_m || std::abs(place.across_m) > 12e3) return;
            const auto bin = static_cast<std::size_t>((place.along_m + reach_m) / bin_m);
            // From 4 to 8 km, the plateau is seen at every range, far from its top.
            for (int level = 7; level < 16; ++level) {
                const std::size_t cell = made.spec.index(ix, iy, level);
                if (made.status[cell] == CellStatus::not_seen) continue;
                ++counts[bin];
                if (made.status[cell] != CellStatus::value) continue;
                sums[bin] += z_of(static_cast<double>(made.values[cell]) - plateau_dbz);
            }
        });
    }
    // Returns the distance at which the share first passes a limit, linear between bins.
    const auto passes_m = [&](double limit) {
        double before = 0;
        for (std::size_t bin = 0; bin < bins; ++bin) {
            if (counts[bin] == 0) continue;
            const double share = sums[bin] / counts[bin];
            const double middle_m = (static_cast<double>(bin) + 0.5) * bin_m - reach_m;
            if (share >= limit) return middle_m - bin_m * (share - limit) / (share - before);
            before = share;
        }
        return reach_m;
    };
    return {(passes_m(0.9) - passes_m(0.1)) / 1000, passes_m(0.5) / 1000};
}

WaveChart wave_chart(const Observed& given, const grid::Method& method) {
    const synth::Wave& wave = given.scene.weather.boxes.front().wave;
    const bool across = wave.azimuth_deg > azimuth_deg + 45;
    // Fit mean + a sin + b cos by least squares.
    std::array<std::array<double, 4>, 3> rows{};
    for (const double shift_m : shifts_m) {
        const grid::Grid made = grid_about(given, method, 0, 33, shift_m);
        for_each_column(given, made, [&](int ix, int iy, const Place& place) {
            if (std::hypot(place.along_m, place.across_m) > 15e3) return;
            const double s_m = across ? place.across_m : place.along_m;
            const double phase = 2 * std::numbers::pi * s_m / wave.length_m;
            const std::array<double, 3> basis = {1, std::sin(phase), std::cos(phase)};
            for (int level = 7; level < 16; ++level) {
                const std::size_t cell = made.spec.index(ix, iy, level);
                if (made.status[cell] != CellStatus::value) continue;
                const auto dbz = static_cast<double>(made.values[cell]);
                for (std::size_t i = 0; i < 3; ++i) {
                    for (std::size_t j = 0; j < 3; ++j)
                        rows[i][j] += basis[i] * basis[j];
                    rows[i][3] += basis[i] * dbz;
                }
            }
        });
    }
    for (std::size_t pivot = 0; pivot < 3; ++pivot) {
        for (std::size_t row = 0; row < 3; ++row) {
            if (row == pivot) continue;
            const double factor = rows[row][pivot] / rows[pivot][pivot];
            for (std::size_t column = pivot; column < 4; ++column)
                rows[row][column] -= factor * rows[pivot][column];
        }
    }
    const double sine = rows[1][3] / rows[1][1];
    const double cosine = rows[2][3] / rows[2][2];
    return {std::hypot(sine, cosine) / wave_db,
            -std::atan2(cosine, sine) / (2 * std::numbers::pi) * wave.length_m / 1000};
}

}  // namespace stormcellar::grid
