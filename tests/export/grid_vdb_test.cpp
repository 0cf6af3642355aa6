// tests/export/check_vdb.py reads the files with OpenVDB.
#include "export/grid_vdb.h"

#include <chrono>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/export/grid_of_all_states.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::vdb {
namespace {

using ::testing::HasSubstr;

grid::Grid small_grid(level2::Moment moment = level2::Moment::ref) {
    return testing::grid_of_all_states(moment, 30, 20, {500, 1000, 1500, 2000});
}

TEST(GridVdb, RefusesLevelsAtUnequalDistances) {
    grid::Grid grid = small_grid();
    grid.spec.levels_m[3] = 2600;
    const auto bytes = vdb_bytes({&grid, 1});
    ASSERT_FALSE(bytes);
    EXPECT_EQ(bytes.error().code, ErrorCode::unsupported);
    EXPECT_THAT(bytes.error().message, HasSubstr("--levels-km bottom:top:step"));
    EXPECT_EQ(vdb_bytes({}).error().code, ErrorCode::bad_argument);
}

#if STORMCELLAR_VDB
TEST(GridVdb, HasAGridOfValuesAndOneOfStatesForEachMoment) {
    const std::vector<grid::Grid> grids = {small_grid(), small_grid(level2::Moment::rho)};
    const auto bytes = vdb_bytes(grids);
    ASSERT_TRUE(bytes) << bytes.error().message;
    std::uint64_t magic = 0;
    std::memcpy(&magic, bytes->data(), sizeof(magic));
    EXPECT_EQ(magic, 0x56444220U) << "' BDV'";
    for (const char* text :
         {"REF", "REF_status", "RHO", "RHO_status", "predicted_error", "0.4 dBZ", "column-linear",
          "2020-09-13T12:26:40Z", "KTLX", "0 not_seen, 1 no_echo, 2 range_folded, 3 value"})
        EXPECT_THAT(*bytes, HasSubstr(text));
}

TEST(GridVdb, HasTheSameBytesForTheSameGrid) {
    const grid::Grid grid = small_grid();
    grid::Grid other = grid;
    other.values[3] += 1;
    const auto first = vdb_bytes({&grid, 1}), second = vdb_bytes({&grid, 1});
    ASSERT_TRUE(first && second);
    EXPECT_EQ(*first, *second);
    EXPECT_NE(*first, *vdb_bytes({&other, 1}));
}

TEST(GridVdb, WritesAFileOrNothing) {
    const testing::TemporaryDirectory directory;
    grid::Grid grid = small_grid();
    const auto path = directory.path() / "a.vdb";
    ASSERT_TRUE(write_vdb(real_file_system(), path, {&grid, 1}, {}));
    EXPECT_EQ(std::filesystem::file_size(path), vdb_bytes({&grid, 1})->size());
    grid.status.pop_back();
    const auto other = directory.path() / "b.vdb";
    EXPECT_FALSE(write_vdb(real_file_system(), other, {&grid, 1}, {}));
    EXPECT_FALSE(std::filesystem::exists(other));
}
#else
TEST(GridVdb, BuildWithoutOpenVdbSaysSo) {
    const grid::Grid grid = small_grid();
    EXPECT_THAT(vdb_bytes({&grid, 1}).error().message, HasSubstr("has no OpenVDB"));
}
#endif

}  // namespace
}  // namespace stormcellar::vdb
