// What a reader finds in the file; tests/export/check_grid.py opens real ones in Python.
#include "export/grid_netcdf.h"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <thread>

#include <gtest/gtest.h>

#include "tests/export/netcdf_reader.h"
#include "tests/testing/power_cut_file_system.h"
#include "tests/testing/temporary_directory.h"

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
    for (std::size_t cell = 0; cell < made.spec.cell_count(); ++cell) {
        made.status.push_back(static_cast<CellStatus>(cell % 4));
        made.values.push_back(static_cast<float>(cell));
    }
    return made;
}

class GridNetcdf : public ::testing::Test {
  protected:
    testing::TemporaryDirectory directory_;
    const std::filesystem::path path_ = directory_.path() / "out.nc";
};

TEST_F(GridNetcdf, EveryCellIsWhereItsCoordinatesSay) {
    const Grid grid = small_grid();
    ASSERT_TRUE(write_grid(real_file_system(), path_, grid));
    Reader reader(path_);
    const auto field = reader.values("REF", grid.spec.cell_count());
    const auto status = reader.values("status", grid.spec.cell_count());
    std::size_t at = 0;
    for (int iz = 0; iz < 3; ++iz) {
        for (int iy = 0; iy < 4; ++iy) {
            for (int ix = 0; ix < 5; ++ix, ++at) {
                const std::size_t cell = grid.spec.index(ix, iy, iz);
                ASSERT_EQ(status[at], static_cast<double>(grid.status[cell]));
                const bool value = grid.status[cell] == CellStatus::value;
                ASSERT_EQ(field[at],
                          static_cast<double>(value ? grid.values[cell] : NC_FILL_FLOAT));
            }
        }
    }
    EXPECT_EQ(reader.values("z", 3), grid.spec.levels_m);
    EXPECT_EQ(reader.values("x", 5), (std::vector<double>{-2000, -1000, 0, 1000, 2000}));
    EXPECT_EQ(reader.values("y", 4), (std::vector<double>{-1500, -500, 500, 1500}));
    EXPECT_NEAR(reader.values("time", 1)[0], 19068 * 86400 + 522.596, 1e-6);
}

TEST_F(GridNetcdf, SaysWhereItComesFrom) {
    ASSERT_TRUE(write_grid(real_file_system(), path_, small_grid()));
    Reader reader(path_);
    EXPECT_EQ(reader.text(nullptr, "Conventions"), "CF-1.8");
    EXPECT_EQ(reader.text(nullptr, "source_files"), "KTLX_FILE");
    EXPECT_EQ(reader.text(nullptr, "volume"), "partial");
    EXPECT_EQ(reader.text(nullptr, "notes"), "first\nsecond");
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

TEST_F(GridNetcdf, TheSameGridGivesTheSameBytes) {
    const auto bytes = [&] {
        EXPECT_TRUE(write_grid(real_file_system(), path_, small_grid()));
        const auto read = read_file(path_);
        return read ? *read : std::vector<std::byte>{};
    };
    const auto first = bytes();
    EXPECT_FALSE(first.empty());
    EXPECT_EQ(first, bytes());
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
    std::ofstream(path_) << "old";
    testing::PowerCutFileSystem file_system;
    file_system.set_space(100);
    const auto written = write_grid(file_system, path_, small_grid());
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().code, ErrorCode::no_space);
    EXPECT_EQ(read_file(path_)->size(), 3U);
    const auto entries = std::filesystem::directory_iterator(directory_.path());
    EXPECT_EQ(std::distance(begin(entries), end(entries)), 1) << "nothing half-written is left";
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
    EXPECT_FALSE(std::filesystem::exists(path_));
}

}  // namespace
}  // namespace stormcellar::netcdf
