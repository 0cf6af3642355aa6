#include "stormcellar/export/grid_format.h"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "stormcellar/export/grid_netcdf.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::grid_export {
namespace {

TEST(GridFormat, IsFoundByTheEndingOfAName) {
    for (const char* name : {"a.nc", "/b.d/a.nc4", ".nc"}) {
        ASSERT_NE(grid_format_of(name), nullptr) << name;
        EXPECT_EQ(grid_format_of(name)->name, "netCDF");
    }
    for (const char* name : {"a", "a.ncx", "a.nc/b", ""})
        EXPECT_EQ(grid_format_of(name), nullptr) << name;
}

TEST(GridFormat, EachEndingBelongsToOneFormatAndIsListed) {
    std::set<std::string_view> seen;
    for (const GridFormat& format : grid_formats()) {
        EXPECT_FALSE(format.endings.empty()) << format.name;
        for (const std::string_view ending : format.endings) {
            EXPECT_TRUE(seen.insert(ending).second) << ending;
            EXPECT_NE(known_grid_formats().find(ending), std::string::npos) << ending;
        }
    }
    const auto listed = grid_endings();
    EXPECT_EQ(std::set(listed.begin(), listed.end()), seen);
}

TEST(GridFormat, NetcdfIsTheDefaultAndWritesWhatWriteGridWrites) {
    grid::Grid grid;
    grid.spec = grid::default_spec(35, -97);
    grid.spec.nx = grid.spec.ny = 3;
    grid.spec.levels_m = {500, 1000};
    grid.sites = {{"KTLX", 35, -97, 389}};
    grid.values.assign(grid.spec.cell_count(), 20);
    grid.status.assign(grid.spec.cell_count(), grid::CellStatus::value);
    const testing::TemporaryDirectory directory;
    const auto direct = directory.path() / "direct.nc";
    const auto by_format = directory.path() / "format.nc";
    ASSERT_TRUE(netcdf::write_grid(real_file_system(), direct, grid));
    const Status written =
        grid_formats().front().write(real_file_system(), by_format, {&grid, 1}, {});
    ASSERT_TRUE(written) << written.error().message;
    EXPECT_EQ(std::filesystem::file_size(direct), std::filesystem::file_size(by_format));
    // The format also refuses a grid whose arrays do not fit.
    grid.values.pop_back();
    EXPECT_FALSE(grid_formats().front().write(real_file_system(), by_format, {&grid, 1}, {}));
}

}  // namespace
}  // namespace stormcellar::grid_export
