#include "export/climatology_netcdf.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stormcellar/grid/brick_grid.h"
#include "stormcellar/grid/grid.h"
#include "tests/export/netcdf_reader.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::netcdf {
namespace {

using grid::CellStatus;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

// Returns a grid of two columns. The first has `dbz` at 2000 m; the second was not seen.
grid::BrickGrid echo(float dbz) {
    grid::Grid grid;
    grid.spec.nx = 2;
    grid.spec.ny = 1;
    grid.spec.levels_m = {1000, 2000};
    grid.spec.center_latitude_deg = 35;
    grid.spec.center_longitude_deg = -97;
    grid.values = {0, dbz, 0, 0};
    grid.status = {CellStatus::no_echo, CellStatus::value, CellStatus::not_seen,
                   CellStatus::not_seen};
    return grid::BrickGrid::from(grid, grid::default_quantization(level2::Moment::ref));
}

TallyGroup hour_of(int number, std::uint64_t instants, const std::vector<float>& echoes,
                   grid::Tallied tallied = grid::Tallied::columns) {
    TallyGroup group{number,
                     instants,
                     {echo(0).spec(), grid::default_quantization(level2::Moment::ref), tallied}};
    for (const float dbz : echoes)
        EXPECT_TRUE(group.tally.add(echo(dbz).view()));
    return group;
}

TEST(ClimatologyNetcdf, SaysWhatWasSeenAndHowOftenItRained) {
    const testing::TemporaryDirectory directory;
    const std::vector<TallyGroup> groups{hour_of(20, 5, {10, 50}), hour_of(21, 1, {})};
    const Status written =
        write_climatology(real_file_system(), directory / "c.nc", groups,
                          {"hour", "2013-05-01T00:00:00Z", "2013-05-31T23:59:59Z", "/archive"});
    ASSERT_TRUE(written) << written.error().message;
    Reader file(directory / "c.nc");
    EXPECT_EQ(file.text(nullptr, "Conventions"), "CF-1.8");
    EXPECT_THAT(file.values("hour", 2), ElementsAre(20, 21));
    EXPECT_THAT(file.values("frames", 2), ElementsAre(2, 0));
    EXPECT_THAT(file.values("missing_frames", 2), ElementsAre(3, 1));
    // Values are in the order of hours, then columns. The second column was never seen, which does
    // not mean that it had no echo.
    EXPECT_THAT(file.values("seen", 4), ElementsAre(2, 0, 0, 0));
    EXPECT_THAT(file.values("not_seen", 4), ElementsAre(0, 2, 0, 0));
    const double fill = file.number("maximum", "_FillValue");
    EXPECT_THAT(file.values("maximum", 4), ElementsAre(50, fill, fill, fill));
    EXPECT_THAT(file.values("mean_dbz", 4), ElementsAre(30, fill, fill, fill));
    const std::size_t thresholds = file.length("threshold");
    const auto edges = file.values("threshold", thresholds);
    EXPECT_EQ(edges.front(), 0);
    EXPECT_EQ(edges.at(10), 50);
    const auto frequency = file.values("frequency", 4 * thresholds);
    EXPECT_EQ(frequency.at(0), 1);         // 0 dBZ in both frames
    EXPECT_EQ(frequency.at(1), fill);      // the blind column
    EXPECT_EQ(frequency.at(2 * 10), 0.5);  // 50 dBZ in one of two frames
    EXPECT_EQ(frequency.at(2 * 11), 0);    // 55 dBZ in no frame
    const auto tops = file.values("echo_top_frequency", 8);
    EXPECT_EQ(tops.at(0), 0.5);  // echo tops at or above 1000 m in one of two frames
    EXPECT_EQ(tops.at(2), 0.5);  // echo tops at or above 2000 m in one of two frames
    EXPECT_THAT(file.text("maximum", "ancillary_variables"), HasSubstr("not_seen"));
    EXPECT_EQ(write_climatology(real_file_system(), directory / "d.nc", {}, {}).error().code,
              ErrorCode::bad_argument);
}

// Values are in the order of levels, then columns. The second column was never seen.
TEST(ClimatologyNetcdf, HasEachCellWhereTheyWereCounted) {
    const testing::TemporaryDirectory directory;
    const std::vector<TallyGroup> groups{
        hour_of(20, 5, {10, 50}, grid::Tallied::columns_and_cells)};
    ASSERT_TRUE(write_climatology(real_file_system(), directory / "c.nc", groups,
                                  {"all", "2013-05-01T00:00:00Z", "2013-05-31T23:59:59Z", "/a"}));
    Reader file(directory / "c.nc");
    EXPECT_THAT(file.values("seen", 2), ElementsAre(2, 0));
    EXPECT_THAT(file.values("cell_seen", 4), ElementsAre(2, 0, 2, 0));
    EXPECT_THAT(file.values("cell_not_seen", 4), ElementsAre(0, 2, 0, 2));
    const double fill = file.number("cell_mean_dbz", "_FillValue");
    EXPECT_THAT(file.values("cell_mean_dbz", 4), ElementsAre(fill, fill, 30, fill));
    EXPECT_THAT(file.values("cell_maximum", 4), ElementsAre(fill, fill, 50, fill));
    const std::size_t thresholds = file.length("threshold");
    const auto frequency = file.values("cell_frequency", 4 * thresholds);
    EXPECT_EQ(frequency.at(0), 0) << "seen at 1000 m, and never an echo";
    EXPECT_EQ(frequency.at(1), fill);
    EXPECT_EQ(frequency.at(2), 1) << "0 dBZ at 2000 m in both frames";
    EXPECT_EQ(frequency.at(4 * 10 + 2), 0.5) << "one of two frames has 50 dBZ";
    EXPECT_THAT(file.text("cell_maximum", "ancillary_variables"), HasSubstr("cell_not_seen"));
}

}  // namespace
}  // namespace stormcellar::netcdf
