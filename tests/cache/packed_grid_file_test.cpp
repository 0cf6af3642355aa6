// Tests files with packed bricks.
#include <algorithm>
#include <cstring>
#include <filesystem>

#include <gtest/gtest.h>

#include "tests/cache/grid_file_fixture.h"

namespace stormcellar::cache {
namespace {

namespace fs = std::filesystem;

class PackedGridFile : public GridFileTest {
  protected:
    Result<std::uint64_t> pack(FileSystem& file_system, int code_bytes = 1) {
        const grid::BrickGrid made = bricks(code_bytes);
        return write_grid_file(file_system, path_, describe(testing::small_grid()), made.view(),
                               Packing::lz4);
    }
};

TEST_P(PackedGridFile, HoldsTheSameCellsInLessSpace) {
    ASSERT_TRUE(write(real_file_system(), GetParam()));
    const auto plain_size = fs::file_size(path_);
    const auto plain = GridFile::open(path_);
    ASSERT_TRUE(pack(real_file_system(), GetParam()));
    const auto packed = GridFile::open(path_);
    ASSERT_TRUE(packed) << packed.error().message;
    EXPECT_EQ(plain->packing(), Packing::none);
    EXPECT_EQ(packed->packing(), Packing::lz4);
    EXPECT_TRUE(packed->verify());
    EXPECT_LT(fs::file_size(path_), plain_size);
    EXPECT_TRUE(std::ranges::equal(packed->view().codes, plain->view().codes))
        << "absent bricks are equal, too";
    EXPECT_EQ(grid::to_dense(packed->view()).status, grid::to_dense(plain->view()).status);
    const auto first = bytes_of(path_);
    ASSERT_TRUE(pack(real_file_system(), GetParam()));
    EXPECT_EQ(bytes_of(path_), first);
}
INSTANTIATE_TEST_SUITE_P(CodeBytes, PackedGridFile, ::testing::Values(1, 2));

// grid_file_test.cpp tests the bytes before the codes.
TEST_F(PackedGridFile, EveryFlippedByteOfTheCodesIsRefused) {
    ASSERT_TRUE(pack(real_file_system()));
    const auto bytes = bytes_of(path_);
    format::FileHeader header;
    std::memcpy(&header, bytes.data(), sizeof header);
    ASSERT_LT(header.codes_offset, bytes.size());
    for (std::size_t i = header.codes_offset; i < bytes.size(); ++i) {
        auto flipped = bytes;
        flipped[i] ^= std::byte{0x10};
        overwrite(path_, flipped);
        ASSERT_EQ(GridFile::open(path_).error().code, ErrorCode::corrupt) << "byte " << i;
    }
}

// 2026-11-28: opening a file of 70 MB from another machine took 8 GiB.
TEST_F(PackedGridFile, TakesNoMoreMemoryThanItsReaderAllows) {
    ASSERT_TRUE(pack(real_file_system()));
    const grid::BrickGrid made = bricks(1);
    const auto stored =
        std::ranges::count(made.view().bricks, grid::BrickKind::stored, &grid::BrickEntry::kind);
    ASSERT_GT(stored, 0);
    const auto bytes = static_cast<std::uint64_t>(stored) * grid::brick_cells;
    const auto size = std::filesystem::file_size(path_);
    EXPECT_TRUE(GridFile::open(path_, {.read_bytes = size, .unpacked_bytes = bytes}));
    const auto is_refused = [&](const GridFileLimits& limits, const std::string& why) {
        const auto file = GridFile::open(path_, limits);
        return !file && file.error().code == ErrorCode::unsupported &&
               file.error().message.find(why) != std::string::npos;
    };
    EXPECT_TRUE(is_refused({.unpacked_bytes = bytes - 1}, "its codes unpack to"));
    EXPECT_TRUE(is_refused({.read_bytes = 4096}, "would be read into memory"));
}

TEST_F(PackedGridFile, IsInMemoryWhenItsFileIsCut) {
    ASSERT_TRUE(pack(real_file_system()));
    const auto file = GridFile::open(path_);
    ASSERT_TRUE(file);
    const auto before = grid::to_dense(file->view()).values;
    fs::resize_file(path_, 4096);
    EXPECT_EQ(grid::to_dense(file->view()).values, before);
    EXPECT_EQ(file->check_whole().error().code, ErrorCode::truncated);
    EXPECT_FALSE(file->verify());
    EXPECT_FALSE(GridFile::open(path_));
}

TEST_F(PackedGridFile, AnAlteredFileIsFoundByVerify) {
    ASSERT_TRUE(pack(real_file_system()));
    const auto file = GridFile::open(path_);
    ASSERT_TRUE(file);
    auto bytes = bytes_of(path_);
    bytes.back() ^= std::byte{1};
    overwrite(path_, bytes);
    EXPECT_EQ(file->verify().error().code, ErrorCode::corrupt);
}

}  // namespace
}  // namespace stormcellar::cache
