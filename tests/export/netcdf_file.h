// tests/export/netcdf_file.h -- a fixture for tests that write a netCDF file, with a check that
// every writer must pass.
#pragma once

#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>

#include <gtest/gtest.h>

#include "stormcellar/export/cfradial.h"
#include "tests/testing/power_cut_file_system.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::netcdf {

class NetcdfFile : public ::testing::Test {
  protected:
    using Write = std::function<Status(FileSystem&)>;

    void expect_the_same_bytes(const Write& write) const {
        const auto bytes = [&] {
            EXPECT_TRUE(write(real_file_system()));
            return read_file(path_).value_or(std::vector<std::byte>{});
        };
        const auto first = bytes();
        EXPECT_FALSE(first.empty());
        EXPECT_EQ(first, bytes());
    }
    // Expects that a write to a full disk fails, keeps the old file and leaves no other file.
    void expect_the_old_file_stays(const Write& write) const {
        std::ofstream(path_) << "old";
        testing::PowerCutFileSystem file_system;
        file_system.set_space(100);
        const Status written = write(file_system);
        ASSERT_FALSE(written);
        EXPECT_EQ(written.error().code, ErrorCode::no_space);
        EXPECT_EQ(read_file(path_)->size(), 3U);
        const auto entries = std::filesystem::directory_iterator(directory_.path());
        EXPECT_EQ(std::distance(begin(entries), end(entries)), 1);
    }

    testing::TemporaryDirectory directory_;
    const std::filesystem::path path_ = directory_.path() / "out.nc";
};

// A test of a format of volumes. `write_file` is the function that writes it, such as write_uf().
template <auto write_file>
class VolumeFile : public NetcdfFile {
  protected:
    void write(const level2::Volume& volume, const VolumeWriteOptions& options = {}) const {
        const Status written = write_file(real_file_system(), path_, volume, options);
        ASSERT_TRUE(written) << written.error().message;
    }
};

// Returns the options that give sweeps with other gates a range axis of their own.
inline VolumeWriteOptions with_all_ranges() {
    VolumeWriteOptions options;
    options.ranges = RangeAxes::of_each_geometry;
    return options;
}

}  // namespace stormcellar::netcdf
