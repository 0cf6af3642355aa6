// Tests what a reader finds in a file; tests/export/check_grid.py reads grids of real volumes in
// Python.
#include "stormcellar/export/grid_netcdf.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <thread>

#include <gtest/gtest.h>

#include "stormcellar/grid/method.h"
#include "tests/export/netcdf_file.h"
#include "tests/export/netcdf_reader.h"

namespace stormcellar::netcdf {
namespace {

using grid::CellStatus;
using grid::Grid;

Grid small_grid() {
    Grid made;
    made.spec = grid::default_spec(35, -97);
    made.spec.nx = 5;
    made.spec.ny = 4;
    made.spec.levels_m = {500, 1000, 2500};
    made.time = time_from_nexrad(19069, 522596);
    made.start_time = made.time;
    made.end_time = made.time + std::chrono::minutes(5);
    made.sites = {{"KTLX", 35, -97, 389}};
    made.provenance.source_files = {"KTLX_FILE"};
    made.provenance.stations = {"KTLX"};
    made.provenance.method = "column-linear";
    made.provenance.vcp = 212;
    made.provenance.partial = true;
    made.provenance.notes = {"first", "second"};
    made.provenance.audit = {{0.5F, 0, 60e3F, 20, 15, 10, 2, 1},
                             {1.5F, 0, 60e3F, 20, 15, 10, 2, 1}};
    for (std::size_t cell = 0; cell < made.spec.cell_count(); ++cell) {
        made.status.push_back(static_cast<CellStatus>(cell % 4));
        made.values.push_back(static_cast<float>(cell));
    }
    return made;
}

class GridNetcdf : public NetcdfFile {};

// Calls check(place in the file, index in the grid) for each cell.
template <class Check>
void for_each_cell(const Grid& grid, const Check& check) {
    std::size_t at = 0;
    for (int iz = 0; iz < grid.spec.nz(); ++iz) {
        for (int iy = 0; iy < grid.spec.ny; ++iy) {
            for (int ix = 0; ix < grid.spec.nx; ++ix)
                check(at++, grid.spec.index(ix, iy, iz));
        }
    }
}

// Compares a field and its states, as they are read, with the grid, cell by cell.
void expect_cells(Reader& reader, const Grid& grid, const std::string& field_name,
                  const std::string& status_name) {
    const auto field = reader.values(field_name.c_str(), grid.spec.cell_count());
    const auto status = reader.values(status_name.c_str(), grid.spec.cell_count());
    for_each_cell(grid, [&](std::size_t at, std::size_t cell) {
        ASSERT_EQ(status[at], static_cast<double>(grid.status[cell]));
        const bool value = grid.status[cell] == CellStatus::value;
        ASSERT_EQ(field[at], static_cast<double>(value ? grid.values[cell] : NC_FILL_FLOAT));
    });
}

TEST_F(GridNetcdf, EveryCellIsWhereItsCoordinatesSay) {
    const Grid grid = small_grid();
    ASSERT_TRUE(write_grid(real_file_system(), path_, grid));
    Reader reader(path_);
    expect_cells(reader, grid, "REF", "status");
    EXPECT_EQ(reader.values("z", 3), grid.spec.levels_m);
    EXPECT_EQ(reader.values("x", 5), (std::vector<double>{-2000, -1000, 0, 1000, 2000}));
    EXPECT_EQ(reader.values("y", 4), (std::vector<double>{-1500, -500, 500, 1500}));
    EXPECT_NEAR(reader.values("time", 1)[0], 19068 * 86400 + 522.596, 1e-6);
    EXPECT_EQ(reader.length("time"), 1U);
    EXPECT_TRUE(reader.is_unlimited("time")) << "2026-11-28: ncrcat joined no files";
}

TEST_F(GridNetcdf, CountsAndWeightsOfAMosaicAreThereWhenAskedFor) {
    Grid grid = small_grid();
    ASSERT_TRUE(write_grid(real_file_system(), path_, grid));
    EXPECT_EQ(Reader(path_).text("REF", "ancillary_variables"), "status");
    for (std::size_t cell = 0; cell < grid.spec.cell_count(); ++cell) {
        grid.site_counts.push_back(static_cast<std::uint16_t>(cell % 7));
        grid.site_weights.push_back(static_cast<float>(cell) / 64);
    }
    ASSERT_TRUE(write_grid(real_file_system(), path_, grid));
    Reader reader(path_);
    EXPECT_EQ(reader.text("REF", "ancillary_variables"), "status site_count site_weight");
    EXPECT_EQ(reader.text("site_count", "standard_name"), "number_of_observations");
    EXPECT_EQ(reader.text("site_count", "units"), "1");
    EXPECT_EQ(reader.text("site_weight", "units"), "1");
    const auto counts = reader.values("site_count", grid.spec.cell_count());
    const auto weights = reader.values("site_weight", grid.spec.cell_count());
    for_each_cell(grid, [&](std::size_t at, std::size_t cell) {
        ASSERT_EQ(counts[at], static_cast<double>(grid.site_counts[cell]));
        ASSERT_EQ(weights[at], static_cast<double>(grid.site_weights[cell]));
    });
    grid.site_counts.pop_back();
    EXPECT_EQ(write_grid(real_file_system(), path_, grid).error().code, ErrorCode::bad_argument);
}

TEST_F(GridNetcdf, SaysWhereItComesFrom) {
    ASSERT_TRUE(write_grid(real_file_system(), path_, small_grid()));
    Reader reader(path_);
    EXPECT_EQ(reader.text(nullptr, "Conventions"), "CF-1.8");
    EXPECT_EQ(reader.text(nullptr, "source_files"), "KTLX_FILE");
    EXPECT_EQ(reader.text(nullptr, "volume"), "partial");
    EXPECT_EQ(reader.text(nullptr, "notes"), "first\nsecond");
    EXPECT_EQ(reader.text(nullptr, "audit"),
              "grid minus gates, scanned as the radar did\n"
              "0 to 60 km: RMS 2.00 dB, mean 1.00 dB over 20 gates; status the same in 75.0 % of "
              "40");
    EXPECT_EQ(reader.text("REF", "units"), "dBZ");
    EXPECT_EQ(reader.text("REF", "grid_mapping"), "azimuthal_equidistant");
    EXPECT_EQ(reader.text("status", "flag_meanings"), "not_seen no_echo range_folded value");
}

TEST_F(GridNetcdf, TheFieldIsNamedByItsMoment) {
    Grid grid = small_grid();
    for (const level2::Moment moment : level2::all_moments) {
        grid.moment = moment;
        ASSERT_TRUE(write_grid(real_file_system(), path_, grid));
        Reader reader(path_);
        const std::string name{level2::moment_name(moment)};
        EXPECT_EQ(reader.text(name.c_str(), "units"), level2::moment_units(moment));
    }
}

// 2026-11-21: means over the area of a cell were described as points.
TEST_F(GridNetcdf, CellMethodsSayWhetherACellIsAPointOrAMean) {
    Grid grid = small_grid();
    const auto written_of = [&](const grid::Method& method) {
        grid.provenance.method = method.name();
        EXPECT_TRUE(write_grid(real_file_system(), path_, grid));
        return Reader(path_).text("REF", "cell_methods");
    };
    grid::Method method;
    for (const auto interpolation :
         {grid::Interpolation::nearest, grid::Interpolation::linear,
          grid::Interpolation::eight_point, grid::Interpolation::beam_weighted}) {
        method.interpolation = interpolation;
        method.cell = grid::CellExtent::point;
        EXPECT_EQ(written_of(method), "area: point") << method.name();
        method.cell = grid::CellExtent::area;
        EXPECT_EQ(written_of(method), "area: mean") << method.name();
    }
}

TEST_F(GridNetcdf, DetailsStandBesideTheFieldWhereTheyAreKnown) {
    Grid grid = small_grid();
    grid::DetailSet set;
    set.add(grid::Detail::age);
    set.add(grid::Detail::distance);
    const std::size_t cells = grid.spec.cell_count();
    grid.details = grid::CellDetails(set, cells);
    for (std::size_t cell = 0; cell < cells; cell += 2) {
        grid.details.put(grid::Detail::age, cell, -0.5F * static_cast<float>(cell));
        if (cell % 4 == 0) grid.details.put(grid::Detail::distance, cell, 7);
    }
    grid.frame_time = grid.time + std::chrono::minutes(3);
    ASSERT_TRUE(write_grid(real_file_system(), path_, grid));
    Reader reader(path_);
    EXPECT_NEAR(reader.values("time", 1)[0], 19068 * 86400 + 702.596, 1e-6);
    EXPECT_EQ(reader.text("time", "long_name"), "frame time");
    EXPECT_EQ(reader.text("REF", "ancillary_variables"), "status age gate_distance");
    EXPECT_EQ(reader.text("age", "units"), "s");
    EXPECT_NE(reader.text("age", "comment").find(format_utc(*grid.frame_time)), std::string::npos);
    EXPECT_EQ(reader.text("gate_distance", "units"), "m");
    EXPECT_FALSE(reader.has_variable("beam_height_offset"));
    EXPECT_FALSE(reader.has_variable("sample_weight"));
    EXPECT_EQ(reader.number("age", "_FillValue"), static_cast<double>(NC_FILL_FLOAT));
    const auto ages_s = reader.values("age", cells);
    const auto distances_m = reader.values("gate_distance", cells);
    std::size_t at = 0;
    for (int iz = 0; iz < 3; ++iz) {
        for (int iy = 0; iy < 4; ++iy) {
            for (int ix = 0; ix < 5; ++ix, ++at) {
                const std::size_t cell = grid.spec.index(ix, iy, iz);
                const auto fill = static_cast<double>(NC_FILL_FLOAT);
                const double age_s = cell % 2 == 0 ? -0.5 * static_cast<double>(cell) : fill;
                ASSERT_EQ(ages_s[at], age_s);
                ASSERT_EQ(distances_m[at], cell % 4 == 0 ? 7 : fill);
            }
        }
    }
}

// 2026-11-25: the dimensions were y and x, and readers that look for lat and lon did not find them.
TEST_F(GridNetcdf, ALatitudeLongitudeGridHasTheDimensionsLatAndLon) {
    Grid grid = small_grid();
    grid.spec.projection = grid::Projection::latitude_longitude;
    grid.spec.spacing_m = 0;
    grid.spec.spacing_deg = 0.5;
    ASSERT_TRUE(write_grid(real_file_system(), path_, grid));
    Reader reader(path_);
    EXPECT_EQ(reader.values("lat", 4), (std::vector<double>{34.25, 34.75, 35.25, 35.75}));
    EXPECT_EQ(reader.values("lon", 5), (std::vector<double>{-98, -97.5, -97, -96.5, -96}));
    EXPECT_EQ(reader.text("lat", "units"), "degrees_north");
    EXPECT_EQ(reader.text("lon", "axis"), "X");
    EXPECT_FALSE(reader.has_variable("x"));
    EXPECT_FALSE(reader.has_variable("y"));
}

std::vector<Grid> two_moments() {
    std::vector<Grid> grids = {small_grid(), small_grid()};
    grids[1].moment = level2::Moment::vel;
    grids[1].end_time += std::chrono::minutes(1);
    grids[1].provenance.method = "column-nearest";
    grids[1].provenance.partial = false;
    grids[1].provenance.notes = {"second", "third"};
    for (float& value : grids[1].values)
        value = -value;
    std::ranges::reverse(grids[1].status);
    return grids;
}

TEST_F(GridNetcdf, SeveralMomentsAreOneFileWithAFieldEach) {
    const std::vector<Grid> grids = two_moments();
    ASSERT_TRUE(write_grids(real_file_system(), path_, grids));
    Reader reader(path_);
    for (const Grid& grid : grids) {
        const std::string name{level2::moment_name(grid.moment)};
        expect_cells(reader, grid, name, name + "_status");
        EXPECT_EQ(reader.text(name.c_str(), "ancillary_variables"), name + "_status");
        EXPECT_EQ(reader.text(name.c_str(), "method"), grid.provenance.method);
    }
    EXPECT_EQ(reader.text(nullptr, "notes"), "first\nsecond\nthird");
    EXPECT_EQ(reader.text(nullptr, "volume"), "partial");
    EXPECT_EQ(reader.text(nullptr, "title"), "KTLX REF VEL gridded, " + format_utc(grids[0].time));
    EXPECT_EQ(reader.text(nullptr, "time_coverage_end"), format_utc(grids[1].end_time));
    EXPECT_FALSE(reader.has_variable("status"));
}

// Writes VEL and VELD into one file. The states of VEL are numbered and described as in a file
// without VELD.
TEST_F(GridNetcdf, OnlyDerivedMomentsHaveTheStateAmbiguous) {
    std::vector<Grid> grids = two_moments();
    grids[0].moment = level2::Moment::veld;
    for (std::size_t cell = 0; cell < grids[0].status.size(); cell += 5)
        grids[0].status[cell] = CellStatus::ambiguous;
    std::ranges::reverse(grids);
    ASSERT_TRUE(write_grids(real_file_system(), path_, grids));
    Reader reader(path_);
    expect_cells(reader, grids[0], "VEL", "VEL_status");
    expect_cells(reader, grids[1], "VELD", "VELD_status");
    EXPECT_EQ(reader.values("VELD_status", grids[1].spec.cell_count())[0], 5)
        << "state 5 is ambiguous";
    using Numbers = std::vector<double>;
    EXPECT_EQ(reader.numbers("VELD_status", "flag_values"), (Numbers{0, 1, 2, 3, 5}));
    EXPECT_EQ(reader.text("VELD_status", "flag_meanings"),
              "not_seen no_echo range_folded value ambiguous");
    const std::string measured =
        "not_seen: blind region, beyond range, missing radials or sweeps; no_echo: seen, below the "
        "radar's threshold; range_folded: echo from beyond the unambiguous range";
    EXPECT_EQ(reader.text("VELD_status", "comment"),
              measured + "; ambiguous: echo whose value cannot be derived");
    EXPECT_EQ(reader.text("VELD", "standard_name"),
              "radial_velocity_of_scatterers_away_from_instrument");
    EXPECT_EQ(reader.numbers("VEL_status", "flag_values"), (Numbers{0, 1, 2, 3}));
    EXPECT_EQ(reader.text("VEL_status", "flag_meanings"), "not_seen no_echo range_folded value");
    EXPECT_EQ(reader.text("VEL_status", "comment"), measured);
}

TEST_F(GridNetcdf, GridsThatDoNotBelongTogetherAreRefused) {
    const auto refused = [&](auto&& change) {
        std::vector<Grid> grids = two_moments();
        change(grids);
        const Status written = write_grids(real_file_system(), path_, grids);
        EXPECT_FALSE(std::filesystem::exists(path_));
        return !written && written.error().code == ErrorCode::bad_argument;
    };
    EXPECT_TRUE(refused([](auto& grids) { grids.clear(); }));
    EXPECT_TRUE(refused([](auto& grids) { grids[1].moment = level2::Moment::ref; }));
    EXPECT_TRUE(refused([](auto& grids) { grids[1].spec.spacing_m = 500; }));
    EXPECT_TRUE(refused([](auto& grids) { grids[1].time += std::chrono::seconds(1); }));
    EXPECT_TRUE(refused([](auto& grids) { grids[1].values.pop_back(); }));
}

TEST_F(GridNetcdf, TheSameGridGivesTheSameBytes) {
    expect_the_same_bytes(
        [&](FileSystem& file_system) { return write_grid(file_system, path_, small_grid()); });
}

TEST_F(GridNetcdf, ThreadsMayWriteAtOnce) {
    std::vector<std::jthread> writers;
    for (int i = 0; i < 4; ++i) {
        writers.emplace_back([this, i] {
            const auto path = directory_.path() / std::to_string(i);
            EXPECT_TRUE(write_grid(real_file_system(), path, small_grid()));
        });
    }
    writers.clear();
    for (int i = 0; i < 4; ++i)
        EXPECT_EQ(Reader(directory_.path() / std::to_string(i)).values("z", 3)[2], 2500);
}

TEST_F(GridNetcdf, AFailedWriteLeavesTheOldFileAlone) {
    expect_the_old_file_stays(
        [&](FileSystem& file_system) { return write_grid(file_system, path_, small_grid()); });
}

TEST_F(GridNetcdf, AWrittenFileSurvivesAPowerCut) {
    testing::PowerCutFileSystem file_system;
    ASSERT_TRUE(write_grid(file_system, path_, small_grid()));
    file_system.power_cut();
    EXPECT_EQ(Reader(path_).values("z", 3)[0], 500);
}

TEST_F(GridNetcdf, RefusesAGridThatDoesNotFitItself) {
    Grid grid = small_grid();
    grid.values.pop_back();
    const auto written = write_grid(real_file_system(), path_, grid);
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().code, ErrorCode::bad_argument);
    EXPECT_FALSE(write_grid(real_file_system(), path_, small_grid(), {10}));
    grid = small_grid();
    grid::DetailSet ages;
    ages.add(grid::Detail::age);
    grid.details = grid::CellDetails(ages, grid.spec.cell_count() - 1);
    EXPECT_FALSE(write_grid(real_file_system(), path_, grid));
    EXPECT_FALSE(std::filesystem::exists(path_));
}

}  // namespace
}  // namespace stormcellar::netcdf
