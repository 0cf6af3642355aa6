#include "tests/hard_cases/grid_case.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include <gtest/gtest.h>

#include "grid/judge/oracle.h"
#include "stormcellar/grid/column_geometry.h"

namespace stormcellar::grid {
namespace {

// tests/grid/gridder_oracle_test.cpp has the same accuracies.
constexpr double height_accuracy_m = 1;
constexpr double weight_accuracy = 2e-3;
constexpr double value_accuracy = 0.05;
constexpr int columns_compared = 40;
constexpr int area_columns_compared = 10;

struct Tally {
    int columns = 0, doubtful_columns = 0;
    int cells = 0, doubtful_cells = 0;
    int other_states = 0, other_values = 0;
};

void compare_cell(const GridCase& given, const Method& method, const Grid& grid,
                  const OracleColumn& slow, int ix, int iy, int level, double slack, Tally& tally) {
    const auto at_level = static_cast<std::size_t>(level);
    const OracleCell low = slow.cell(at_level, -height_accuracy_m);
    const OracleCell here = slow.cell(at_level);
    const OracleCell high = slow.cell(at_level, height_accuracy_m);
    const std::size_t at = given.spec.index(ix, iy, level);
    ++tally.cells;
    if (low.status != here.status || high.status != here.status || here.margin < weight_accuracy ||
        here.wide_on_circle) {
        ++tally.doubtful_cells;
        return;
    }
    const bool area = method.cell == CellExtent::area;
    if (grid.status[at] != here.status) {
        ++tally.other_states;
        if (!area) {
            ADD_FAILURE() << label(method) << ": column " << ix << " " << iy << " level " << level
                          << ": " << cell_status_name(grid.status[at]) << ", oracle "
                          << cell_status_name(here.status);
        }
        return;
    }
    if (here.status != CellStatus::value) return;
    const double tolerance =
        std::abs(low.value - here.value) + std::abs(high.value - here.value) + slack;
    const auto value = static_cast<double>(grid.values[at]);
    if (std::abs(value - here.value) <= tolerance) return;
    ++tally.other_values;
    if (!area) {
        ADD_FAILURE() << label(method) << ": column " << ix << " " << iy << " level " << level
                      << ": " << value << ", oracle " << here.value << " +- " << tolerance;
    }
}

bool same_bits(const Grid& a, const Grid& b) {
    return a.status == b.status &&
           std::memcmp(a.values.data(), b.values.data(), a.values.size() * sizeof(float)) == 0;
}

Result<Grid> made_with(const GridCase& given, const Method& method, const ColumnGeometry& geometry,
                       int threads) {
    GridderOptions options;
    options.moment = given.moment;
    options.beam_width_deg = given.beam_width_deg;
    options.threads = threads;
    options.method = method;
    options.profile = given.profile;
    return make_grid(given.volume, given.site, geometry, options);
}

}  // namespace

std::string label(const Method& method) {
    return method.name() + (method.averaging == Averaging::in_z ? " in Z" : "");
}

std::vector<Method> all_methods(level2::Moment moment) {
    std::vector<Method> methods;
    for (const Interpolation interpolation :
         {Interpolation::nearest, Interpolation::linear, Interpolation::eight_point,
          Interpolation::beam_weighted}) {
        for (const CellExtent cell : {CellExtent::point, CellExtent::area}) {
            methods.push_back(method_of(interpolation, cell));
            if (moment != level2::Moment::ref) continue;
            methods.push_back(method_of(interpolation, cell, Averaging::in_z));
        }
    }
    return methods;
}

GridSpec plane_about(const SitePosition& site, int side, double spacing_m,
                     const std::vector<double>& levels_km) {
    GridSpec spec;
    spec.center_latitude_deg = site.latitude_deg;
    spec.center_longitude_deg = site.longitude_deg;
    spec.nx = spec.ny = side;
    spec.spacing_m = spacing_m;
    for (const double level_km : levels_km)
        spec.levels_m.push_back(level_km * 1000);
    return spec;
}

GridCase about(const SitePosition& site, const std::vector<SweepPlan>& plans, int side,
               double spacing_m) {
    GridCase given;
    given.volume = make_volume(plans);
    given.site = site;
    given.spec = plane_about(site, side, spacing_m, {0.5, 1, 1.5, 2, 3, 4, 6, 9, 14});
    return given;
}

RefractivityProfile duct_under_a_layer() {
    const std::vector<RefractivityLevel> levels = {
        {0, 340}, {40, 338.4}, {190, 224.4}, {1000, 200}, {10000, 60}};
    return RefractivityProfile::from_levels(levels, "duct").value();
}

Grid grid_of(const GridCase& given, const Method& method, double least, double greatest) {
    const auto geometry = make_column_geometry(given.site, given.spec);
    if (!geometry) {
        ADD_FAILURE() << geometry.error().message;
        return {};
    }
    auto one = made_with(given, method, **geometry, 1);
    if (!one) {
        ADD_FAILURE() << label(method) << ": " << one.error().message;
        return {};
    }
    for (const int threads : {2, 7}) {
        const auto other = made_with(given, method, **geometry, threads);
        EXPECT_TRUE(other && same_bits(*one, *other)) << label(method) << " " << threads;
    }
    for (std::size_t cell = 0; cell < one->status.size(); ++cell) {
        if (one->status[cell] != CellStatus::value) continue;
        const auto value = static_cast<double>(one->values[cell]);
        if (std::isfinite(value) && value >= least && value <= greatest) continue;
        ADD_FAILURE() << label(method) << ": cell " << cell << " holds " << value;
        break;
    }
    return std::move(*one);
}

void expect_agrees_with_oracle(const GridCase& given, const Method& method, const Grid& grid,
                               const Agreement& agreement) {
    const auto chosen = choose_sweeps(given.volume, given.moment, given.beam_width_deg / 2);
    const OracleSetting setting{given.moment, given.beam_width_deg, false, method, given.profile};
    const bool area = method.cell == CellExtent::area;
    const auto count = static_cast<int>(given.spec.column_count());
    // An odd step visits all rows and columns of the grid evenly.
    const int step = std::max(1, count / (area ? area_columns_compared : columns_compared)) | 1;
    Tally tally;
    for (int column = step / 2; column < count; column += step) {
        const int ix = column % given.spec.nx;
        const int iy = column / given.spec.nx;
        const OracleColumn slow(given.volume, chosen, setting, given.site, given.spec, ix, iy);
        ++tally.columns;
        if (slow.is_doubtful()) {
            ++tally.doubtful_columns;
            continue;
        }
        for (int level = 0; level < given.spec.nz(); ++level) {
            compare_cell(given, method, grid, slow, ix, iy, level,
                         area ? agreement.area_tolerance : value_accuracy, tally);
        }
    }
    EXPECT_LE(tally.doubtful_columns, agreement.most_doubtful * tally.columns) << label(method);
    EXPECT_LE(tally.doubtful_cells, agreement.most_doubtful * tally.cells) << label(method);
    EXPECT_LE(tally.other_states, 1 + tally.cells / 100) << label(method);
    EXPECT_LE(tally.other_values, 1 + tally.cells / 100) << label(method);
}

void expect_sound_by_every_method(const GridCase& given, const Agreement& agreement,
                                  const Check& check) {
    for (const Method& method : all_methods(given.moment)) {
        const Grid grid = grid_of(given, method);
        if (grid.status.empty()) continue;
        expect_agrees_with_oracle(given, method, grid, agreement);
        if (check) check(method, grid);
    }
}

std::uint16_t patchy_code(double azimuth_deg, double range_m) {
    const double azimuth = azimuth_deg * std::numbers::pi / 180;
    const double east_km = range_m / 1000 * std::sin(azimuth);
    const double north_km = range_m / 1000 * std::cos(azimuth);
    const double patch = std::sin(east_km / 17) * std::cos(north_km / 23);
    if (patch > 0.6) return below_threshold;
    if (patch < -0.7) return range_folded;
    return ref_code(30 + 20 * std::sin(east_km / 31) * std::sin(north_km / 37));
}

SweepPlan patchy_plan(double elevation_deg, int cut) {
    SweepPlan plan;
    plan.elevation_deg = elevation_deg;
    plan.cut = cut;
    plan.gates = 150;
    plan.code = [](int radial, int gate) { return patchy_code(radial + 0.5, 1000.0 * gate); };
    return plan;
}

}  // namespace stormcellar::grid
