// tests/cache/grid_file_fixture.h -- the file of a small grid, which tests write, alter and open.
#pragma once

#include <cstring>
#include <filesystem>
#include <fstream>
#include <vector>

#include <gtest/gtest.h>

#include "base/checksum.h"
#include "cache/format.h"
#include "stormcellar/cache/grid_file.h"
#include "tests/cache/made_grids.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::cache {

inline std::vector<std::byte> bytes_of(const std::filesystem::path& path) {
    return *read_file(path);
}

inline void overwrite(const std::filesystem::path& path, const std::vector<std::byte>& bytes) {
    std::ofstream file(path, std::ios::binary | std::ios::trunc);
    file.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
}

class GridFileTest : public ::testing::TestWithParam<int> {
  protected:
    static grid::BrickGrid bricks(int code_bytes) {
        grid::Quantization quantization;
        quantization.code_bytes = code_bytes;
        return grid::BrickGrid::from(testing::small_grid(), quantization);
    }
    Result<std::uint64_t> write(FileSystem& file_system, int code_bytes = 1) {
        const grid::BrickGrid made = bricks(code_bytes);
        return write_grid_file(file_system, path_, describe(testing::small_grid()), made.view());
    }
    // Opens the file, and returns the code of the error, or `empty` if there is none.
    [[nodiscard]] ErrorCode opened() const {
        const auto file = GridFile::open(path_);
        return file ? ErrorCode::empty : file.error().code;
    }
    [[nodiscard]] ErrorCode opened_as_written(const grid::Grid& grid) const {
        const grid::BrickGrid made = grid::BrickGrid::from(grid, {});
        EXPECT_TRUE(write_grid_file(real_file_system(), path_, describe(grid), made.view()));
        return opened();
    }
    // Changes the header of these bytes, corrects its checksum, and returns opened() of the file.
    template <class Change>
    [[nodiscard]] ErrorCode opened_with_header(std::vector<std::byte> bytes, Change change) const {
        format::FileHeader header;
        std::memcpy(&header, bytes.data(), sizeof header);
        change(header);
        header.checksum = 0;
        std::memcpy(bytes.data(), &header, sizeof header);
        header.checksum = xxh3_64(std::span(bytes).first(header.codes_offset));
        std::memcpy(bytes.data(), &header, sizeof header);
        overwrite(path_, bytes);
        return opened();
    }

    testing::TemporaryDirectory directory_;
    std::filesystem::path path_ = directory_ / "a.scg";
};

}  // namespace stormcellar::cache
