#include "cache/grid_file.h"

#include <fstream>
#include <set>

#include <gtest/gtest.h>

#include "cache/format.h"
#include "tests/cache/small_grid.h"
#include "tests/testing/power_cut_file_system.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::cache {
namespace {

namespace fs = std::filesystem;

std::vector<std::byte> bytes_of(const fs::path& path) {
    return *read_file(path);
}

void overwrite(const fs::path& path, const std::vector<std::byte>& bytes) {
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
    testing::TemporaryDirectory directory_;
    fs::path path_ = directory_ / "a.scg";
};

TEST_P(GridFileTest, RoundTripKeepsEveryCellAndEveryFact) {
    const grid::Grid grid = testing::small_grid();
    ASSERT_TRUE(write(real_file_system(), GetParam()));
    const auto file = GridFile::open(path_);
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_TRUE(file->verify());

    const grid::Grid back = grid::to_dense(file->view());
    EXPECT_EQ(back.spec, grid.spec);
    EXPECT_EQ(back.status, grid.status);
    for (std::size_t i = 0; i < grid.values.size(); ++i) {
        if (grid.status[i] == grid::CellStatus::value) {
            EXPECT_NEAR(back.values[i], grid.values[i], 0.25) << "half a step";
        }
    }
    const GridDescription& about = file->description();
    EXPECT_EQ(about.time, grid.time);
    EXPECT_EQ(about.end_time, grid.end_time);
    ASSERT_EQ(about.sites.size(), 1U);
    EXPECT_EQ(about.sites[0].icao, "KBGM");
    EXPECT_EQ(about.sites[0].altitude_m, 519.1);
    EXPECT_EQ(about.provenance.source_files, grid.provenance.source_files);
    EXPECT_EQ(about.provenance.method, "column-linear");
    EXPECT_EQ(about.provenance.notes, grid.provenance.notes);
    EXPECT_EQ(about.provenance.vcp, 21);
    EXPECT_TRUE(about.provenance.partial);
}
INSTANTIATE_TEST_SUITE_P(CodeBytes, GridFileTest, ::testing::Values(1, 2));

TEST_F(GridFileTest, SmallGridHoldsEveryKindOfBrick) {
    std::set<grid::BrickKind> kinds;
    const grid::BrickGrid made = bricks(1);
    for (const auto& entry : made.view().bricks)
        kinds.insert(entry.kind);
    EXPECT_EQ(kinds.size(), 3U);
}

TEST_F(GridFileTest, SameGridGivesTheSameBytes) {
    ASSERT_TRUE(write(real_file_system()));
    const auto first = bytes_of(path_);
    ASSERT_TRUE(write(real_file_system()));
    EXPECT_EQ(bytes_of(path_), first);
}

// One bit of each byte before the codes: the checksum, or what it protects, has changed.
TEST_F(GridFileTest, EveryFlippedByteBeforeTheCodesIsRefused) {
    ASSERT_TRUE(write(real_file_system()));
    auto bytes = bytes_of(path_);
    format::FileHeader header;
    std::memcpy(&header, bytes.data(), sizeof header);
    ASSERT_GT(header.codes_offset, 0U);
    for (std::size_t i = 0; i < header.codes_offset; ++i) {
        const std::byte flipped = bytes[i] ^ std::byte{0x10};
        std::fstream file(path_, std::ios::in | std::ios::out | std::ios::binary);
        file.seekp(static_cast<std::streamoff>(i)).put(static_cast<char>(flipped));
        file.close();
        EXPECT_FALSE(GridFile::open(path_)) << "byte " << i;
        file.open(path_, std::ios::in | std::ios::out | std::ios::binary);
        file.seekp(static_cast<std::streamoff>(i)).put(static_cast<char>(bytes[i]));
    }
    EXPECT_TRUE(GridFile::open(path_)) << "put back as it was";
}

TEST_F(GridFileTest, EveryTruncationIsRefused) {
    ASSERT_TRUE(write(real_file_system()));
    const auto size = fs::file_size(path_);
    for (std::uintmax_t cut = 0; cut < size; cut += 512) {
        fs::resize_file(path_, cut);
        const auto file = GridFile::open(path_);
        ASSERT_FALSE(file) << cut;
        EXPECT_NE(file.error().message.find("a.scg"), std::string::npos);
        ASSERT_TRUE(write(real_file_system()));
    }
}

TEST_F(GridFileTest, FlippedCodeIsFoundByVerify) {
    ASSERT_TRUE(write(real_file_system()));
    auto bytes = bytes_of(path_);
    bytes[bytes.size() - 1] ^= std::byte{1};  // in the place of an absent brick
    overwrite(path_, bytes);
    EXPECT_FALSE(GridFile::open(path_)->verify());

    ASSERT_TRUE(write(real_file_system()));
    bytes = bytes_of(path_);
    format::FileHeader header;
    std::memcpy(&header, bytes.data(), sizeof header);
    bytes[header.codes_offset + 5] ^= std::byte{1};  // in the first brick, which is stored
    overwrite(path_, bytes);
    const auto file = GridFile::open(path_);
    ASSERT_TRUE(file) << "bricks are not read at open";
    EXPECT_EQ(file->verify().error().code, ErrorCode::corrupt);
}

TEST_F(GridFileTest, FileCutUnderTheMapIsAnErrorOfCheckAndVerify) {
    ASSERT_TRUE(write(real_file_system()));
    const auto file = GridFile::open(path_);
    ASSERT_TRUE(file);
    EXPECT_TRUE(file->check_whole());
    fs::resize_file(path_, 4096);
    EXPECT_EQ(file->check_whole().error().code, ErrorCode::truncated);
    EXPECT_FALSE(file->verify());
}

TEST_F(GridFileTest, ReaderKeepsItsFileWhenItIsReplaced) {
    ASSERT_TRUE(write(real_file_system(), 1));
    const auto file = GridFile::open(path_);
    ASSERT_TRUE(file);
    ASSERT_TRUE(write(real_file_system(), 2));
    EXPECT_TRUE(file->verify());
    EXPECT_EQ(file->view().quantization.code_bytes, 1);
}

TEST_F(GridFileTest, PowerCutAtEveryOperationLeavesAWholeFileOrNone) {
    bool finished = false;
    std::uint64_t operation = 0;
    for (; !finished; ++operation) {
        fs::remove(path_);
        testing::PowerCutFileSystem file_system;
        file_system.fail_from(operation);
        finished = write(file_system).has_value();
        file_system.power_cut();
        if (fs::exists(path_)) {
            const auto file = GridFile::open(path_);
            ASSERT_TRUE(file) << "operation " << operation << ": " << file.error().message;
            EXPECT_TRUE(file->verify());
        }
    }
    EXPECT_TRUE(fs::exists(path_));
    EXPECT_GE(operation, 6U);
}

TEST_F(GridFileTest, FullDiskLeavesNothing) {
    testing::PowerCutFileSystem file_system;
    file_system.set_space(6000);
    EXPECT_EQ(write(file_system).error().code, ErrorCode::no_space);
    EXPECT_TRUE(fs::is_empty(directory_.path()));
}

TEST_F(GridFileTest, OtherThingsAreNamed) {
    EXPECT_EQ(GridFile::open(path_).error().code, ErrorCode::not_found);
    std::ofstream(path_).flush();
    EXPECT_FALSE(GridFile::open(path_));
    std::ofstream(path_) << std::string(10000, 'x');
    EXPECT_EQ(GridFile::open(path_).error().code, ErrorCode::corrupt);
    EXPECT_EQ(GridFile::open(directory_.path()).error().code, ErrorCode::not_a_file);
}

}  // namespace
}  // namespace stormcellar::cache
