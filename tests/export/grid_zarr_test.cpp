#include "export/grid_zarr.h"

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <libdeflate.h>
#include <nlohmann/json.hpp>

#include "export/zarr_chunks.h"
#include "stormcellar/export/grid_format.h"
#include "tests/export/grid_of_all_states.h"
#include "tests/testing/power_cut_file_system.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::zarr {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

// Two chunks of columns, and a level spacing that is not regular.
grid::Grid small_grid(level2::Moment moment = level2::Moment::ref, int columns = chunk_side + 3) {
    auto grid = testing::grid_of_all_states(moment, columns, 5, {500, 1000, 2500});
    grid.provenance.vcp = 212;
    return grid;
}

std::string text_of(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    EXPECT_TRUE(file) << path;
    return {std::istreambuf_iterator<char>(file), {}};
}

nlohmann::json json_in(const fs::path& path) {
    return nlohmann::json::parse(text_of(path));
}

template <class Number>
std::vector<Number> chunk_in(const fs::path& path, std::size_t count) {
    const std::string packed = text_of(path);
    std::vector<Number> numbers(count);
    libdeflate_decompressor* decompressor = ::libdeflate_alloc_decompressor();
    EXPECT_EQ(::libdeflate_gzip_decompress(decompressor, packed.data(), packed.size(),
                                           numbers.data(), count * sizeof(Number), nullptr),
              LIBDEFLATE_SUCCESS)
        << path;
    ::libdeflate_free_decompressor(decompressor);
    return numbers;
}

std::set<std::string> files_below(const fs::path& directory) {
    std::set<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator(directory)) {
        if (entry.is_regular_file()) names.insert(entry.path().lexically_relative(directory));
    }
    return names;
}

TEST(GridZarr, HasEveryCellInBothVersions) {
    const testing::TemporaryDirectory directory;
    const grid::Grid grid = small_grid();
    const fs::path two = directory.path() / "a.zarr", three = directory.path() / "a.zarr3";
    ASSERT_TRUE(write_store(real_file_system(), two, {&grid, 1}, ZarrVersion::two));
    ASSERT_TRUE(write_store(real_file_system(), three, {&grid, 1}, ZarrVersion::three));
    const std::size_t count = std::size_t{3} * chunk_side * chunk_side;
    for (int part = 0; part < 2; ++part) {
        const auto values = chunk_in<float>(two / "REF" / fmt::format("0.0.0.{}", part), count);
        const auto states =
            chunk_in<std::int8_t>(two / "status" / fmt::format("0.0.0.{}", part), count);
        EXPECT_EQ(text_of(two / "REF" / fmt::format("0.0.0.{}", part)),
                  text_of(three / "REF" / fmt::format("c/0/0/0/{}", part)));
        for (std::size_t at = 0; at < count; ++at) {
            const int ix = part * chunk_side + static_cast<int>(at % chunk_side);
            const int iy = static_cast<int>(at / chunk_side % chunk_side);
            const int iz = static_cast<int>(at / chunk_side / chunk_side);
            if (ix >= grid.spec.nx || iy >= grid.spec.ny) {
                ASSERT_TRUE(std::isnan(values[at]));
                ASSERT_EQ(states[at], status_unavailable);
                continue;
            }
            const std::size_t cell = grid.spec.index(ix, iy, iz);
            ASSERT_EQ(states[at], static_cast<int>(grid.status[cell]));
            if (grid.status[cell] == grid::CellStatus::value)
                ASSERT_EQ(values[at], grid.values[cell]);
            else
                ASSERT_TRUE(std::isnan(values[at]));
        }
    }
    EXPECT_EQ(chunk_in<double>(two / "z/0", 3), grid.spec.levels_m);
    EXPECT_EQ(chunk_in<double>(three / "time/c/0", 1), std::vector<double>{1.6e9});
    EXPECT_EQ(chunk_in<double>(two / "x/0", 131)[0], -65'000);
}

TEST(GridZarr, StatesErrorMethodAndStatesAsNetcdfDoes) {
    const testing::TemporaryDirectory directory;
    const grid::Grid grid = small_grid();
    const fs::path store = directory.path() / "a.zarr";
    ASSERT_TRUE(write_store(real_file_system(), store, {&grid, 1}, ZarrVersion::two));
    const auto attributes = json_in(store / ".zattrs");
    EXPECT_EQ(attributes["predicted_error"], "0.4 dBZ");
    EXPECT_EQ(attributes["method"], "column-linear");
    EXPECT_EQ(attributes["vcp"], 212);
    EXPECT_EQ(attributes["stations"], "KTLX");
    const auto states = json_in(store / "status/.zattrs");
    EXPECT_EQ(states["flag_values"], nlohmann::json({0, 1, 2, 3, 4}));
    EXPECT_EQ(states["flag_meanings"], "not_seen no_echo range_folded value unavailable");
    EXPECT_EQ(json_in(store / "status/.zarray")["fill_value"], 4);
    const auto all = json_in(store / ".zmetadata")["metadata"];
    for (const char* name : {"REF", "status", "time", "z", "y", "x", "lat", "lon"}) {
        EXPECT_EQ(all[std::string(name) + "/.zarray"], json_in(store / name / ".zarray")) << name;
    }
}

// Moments of one file have their own names and facts, as in a netCDF file.
TEST(GridZarr, HoldsSeveralMoments) {
    const testing::TemporaryDirectory directory;
    const std::vector<grid::Grid> grids = {small_grid(), small_grid(level2::Moment::rho)};
    const fs::path store = directory.path() / "a.zarr3";
    ASSERT_TRUE(write_store(real_file_system(), store, grids, ZarrVersion::three));
    const auto group = json_in(store / "zarr.json");
    EXPECT_FALSE(group["attributes"].contains("predicted_error"));
    const auto& arrays = group["consolidated_metadata"]["metadata"];
    EXPECT_EQ(arrays["RHO"]["attributes"]["predicted_error"], "0.4 dBZ");
    EXPECT_EQ(arrays["RHO"]["attributes"]["ancillary_variables"], "RHO_status");
    EXPECT_TRUE(fs::exists(store / "REF_status/c/0/0/0/1"));
}

TEST(GridZarr, ReplacesAZarrGroupButNoOtherDirectory) {
    const testing::TemporaryDirectory directory;
    const grid::Grid grid = small_grid();
    const fs::path store = directory.path() / "a.zarr";
    ASSERT_TRUE(write_store(real_file_system(), store, {&grid, 1}, ZarrVersion::three));
    std::ofstream(store / "left-over") << "x";
    ASSERT_TRUE(write_store(real_file_system(), store, {&grid, 1}, ZarrVersion::two));
    EXPECT_FALSE(fs::exists(store / "left-over"));
    EXPECT_FALSE(fs::exists(store / "zarr.json"));
    const fs::path other = directory.path() / "b.zarr", file = directory.path() / "c.zarr";
    fs::create_directory(other);
    std::ofstream(other / "thesis.tex") << "x";
    std::ofstream(file) << "x";
    for (const fs::path& kept : {other, file}) {
        const Status checked = check_store(kept);
        ASSERT_FALSE(checked);
        EXPECT_THAT(checked.error().message, HasSubstr(kept.native()));
        EXPECT_FALSE(write_store(real_file_system(), kept, {&grid, 1}, ZarrVersion::two));
    }
    EXPECT_TRUE(fs::exists(other / "thesis.tex"));
    EXPECT_TRUE(fs::is_regular_file(file));
    EXPECT_EQ(check_store(directory.path() / "no/a.zarr").error().code, ErrorCode::not_found);
    EXPECT_TRUE(check_store(store));
}

// Whichever operation fails, the old store or the whole new store has the name, and no part of the
// store without the name is left.
TEST(GridZarr, IsWholeOrOldWhateverFails) {
    const grid::Grid grid = small_grid(level2::Moment::ref, 4);
    grid::Grid newer = grid;
    newer.values.assign(newer.values.size(), 7);
    newer.provenance.method = "nearest";
    std::uint64_t operations = 0;
    {
        const testing::TemporaryDirectory directory;
        testing::PowerCutFileSystem counting;
        ASSERT_TRUE(
            write_store(counting, directory.path() / "a.zarr", {&grid, 1}, ZarrVersion::two));
        operations = counting.operation_count();
    }
    ASSERT_GT(operations, 30U);
    for (std::uint64_t failing = 0; failing <= operations + 3; ++failing) {
        const testing::TemporaryDirectory directory;
        const fs::path store = directory.path() / "a.zarr";
        testing::PowerCutFileSystem good;
        ASSERT_TRUE(write_store(good, store, {&grid, 1}, ZarrVersion::two));
        const auto names = files_below(store);
        testing::PowerCutFileSystem failing_system;
        failing_system.fail_from(failing);
        const Status written = write_store(failing_system, store, {&newer, 1}, ZarrVersion::two);
        if (!written) {
            EXPECT_THAT(written.error().message, HasSubstr(store.native()));
        }
        // If the disk fails between the two renames, the old store keeps its temporary name.
        const fs::path whole =
            fs::exists(store) ? store : fs::directory_iterator(directory.path())->path();
        EXPECT_EQ(files_below(whole), names) << failing;
        const auto method = json_in(whole / ".zattrs")["method"];
        EXPECT_TRUE(method == (written ? "nearest" : "column-linear") || method == "nearest");
        EXPECT_EQ(std::distance(fs::directory_iterator(directory.path()), {}), 1) << failing;
    }
}

TEST(GridZarr, RefusesGridsThatDoNotFit) {
    const testing::TemporaryDirectory directory;
    grid::Grid grid = small_grid();
    grid.values.pop_back();
    const fs::path store = directory.path() / "a.zarr";
    EXPECT_EQ(write_store(real_file_system(), store, {&grid, 1}, ZarrVersion::two).error().code,
              ErrorCode::bad_argument);
    EXPECT_EQ(write_store(real_file_system(), store, {}, ZarrVersion::two).error().code,
              ErrorCode::bad_argument);
    EXPECT_TRUE(files_below(directory.path()).empty());
}

TEST(GridZarr, IsWrittenByTheEndingOfTheName) {
    EXPECT_EQ(grid_export::grid_format_of("a.zarr")->name, "Zarr 2");
    EXPECT_EQ(grid_export::grid_format_of("a.zarr3")->name, "Zarr 3");
}

}  // namespace
}  // namespace stormcellar::zarr
