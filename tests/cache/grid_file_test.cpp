#include "stormcellar/cache/grid_file.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <set>

#include <gtest/gtest.h>

#include "base/checksum.h"
#include "cache/format.h"
#include "tests/cache/grid_file_fixture.h"
#include "tests/testing/power_cut_file_system.h"

namespace stormcellar::cache {
namespace {

namespace fs = std::filesystem;

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
            EXPECT_NEAR(back.values[i], grid.values[i], 0.25) << "the error is at most half a step";
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
    EXPECT_EQ(about.provenance.effects, grid.provenance.effects);
    EXPECT_EQ(about.provenance.predicted_error, "position 714 m");
    EXPECT_EQ(about.provenance.notes, grid.provenance.notes);
    EXPECT_EQ(about.provenance.radar_troubles, grid.provenance.radar_troubles);
    EXPECT_EQ(about.provenance.left_out, grid.provenance.left_out);
    EXPECT_EQ(about.provenance.sweeps, grid.provenance.sweeps);
    EXPECT_TRUE(about.provenance.provisional);
    EXPECT_EQ(about.provenance.revision, 3);
    EXPECT_EQ(about.provenance.parts, grid.provenance.parts);
    EXPECT_EQ(about.provenance.recipe, grid.provenance.recipe);
    EXPECT_EQ(about.provenance.vcp, 21);
    EXPECT_TRUE(about.provenance.partial);
    EXPECT_EQ(about.provenance.audit, grid.provenance.audit);
}
// The header of a file names the moment, and only derived moments use code 3, for ambiguous cells.
TEST_P(GridFileTest, RoundTripKeepsAmbiguousCells) {
    const grid::Grid grid = testing::ambiguous_grid();
    const grid::Quantization quantization{GetParam(), -32, 0.5F, true};
    const grid::BrickGrid made = grid::BrickGrid::from(grid, quantization);
    for (const Packing packing : {Packing::none, Packing::lz4}) {
        ASSERT_TRUE(
            write_grid_file(real_file_system(), path_, describe(grid), made.view(), packing));
        const auto file = GridFile::open(path_);
        ASSERT_TRUE(file) << file.error().message;
        EXPECT_TRUE(file->verify());
        EXPECT_EQ(file->description().moment, level2::Moment::veld);
        EXPECT_EQ(file->view().quantization, quantization);
        const grid::Grid back = grid::to_dense(file->view());
        EXPECT_EQ(back.status, grid.status);
        EXPECT_EQ(back.values, grid::to_dense(made.view()).values);
    }
}

INSTANTIATE_TEST_SUITE_P(CodeBytes, GridFileTest, ::testing::Values(1, 2));

TEST_F(GridFileTest, EveryProjectionComesBack) {
    grid::Grid grid = testing::small_grid();
    grid.spec.projection = grid::Projection::latitude_longitude;
    grid.spec.spacing_m = 0;
    grid.spec.spacing_deg = 0.0123;
    const auto round_trip = [&] {
        const grid::BrickGrid made = grid::BrickGrid::from(grid, {});
        EXPECT_TRUE(write_grid_file(real_file_system(), path_, describe(grid), made.view()));
        const auto file = GridFile::open(path_);
        EXPECT_TRUE(file);
        return file ? file->description().spec : grid::GridSpec{};
    };
    EXPECT_EQ(round_trip(), grid.spec);
    grid.spec.projection = grid::Projection::lambert_conformal;
    grid.spec.spacing_m = 3000;
    grid.spec.spacing_deg = 0;
    grid.spec.parallels_deg = {33, 45.5};
    EXPECT_EQ(round_trip(), grid.spec);
}

TEST_F(GridFileTest, AWindowComesBackAndOldReadersAreTold) {
    grid::Grid grid = testing::small_grid();
    const auto header_of = [&](double offset_x, double offset_y) {
        grid.spec.offset_x_cells = offset_x;
        grid.spec.offset_y_cells = offset_y;
        const grid::BrickGrid made = grid::BrickGrid::from(grid, {});
        EXPECT_TRUE(write_grid_file(real_file_system(), path_, describe(grid), made.view()));
        const auto file = GridFile::open(path_);
        EXPECT_TRUE(file);
        EXPECT_EQ(file.value().description().spec, grid.spec);
        format::FileHeader header;
        std::memcpy(&header, bytes_of(path_).data(), sizeof header);
        return header;
    };
    EXPECT_EQ(header_of(0, 0).required_features, 0U);
    EXPECT_EQ(header_of(0, -0.5).required_features, format::feature_window);
    const format::FileHeader header = header_of(-1000, 31.5);
    EXPECT_EQ(header.required_features, format::feature_window);
    EXPECT_EQ(header.offset_x_cells, -1000);
    EXPECT_EQ(header.offset_y_cells, 31.5);
}

// Version 1 also had record 11, the modification time of the source.
TEST_F(GridFileTest, TheVersionBeforeIsReadAndALaterOneRefused) {
    ASSERT_TRUE(write(real_file_system()));
    auto bytes = bytes_of(path_);
    const GridDescription now = GridFile::open(path_)->description();
    format::FileHeader header;
    std::memcpy(&header, bytes.data(), sizeof header);
    EXPECT_EQ(header.version, 2U);
    // The first record, of 24 bytes, is the name of the source. Record 11 takes the place of this
    // record.
    const std::array<std::uint32_t, 6> record = {11, 8, 123'456'789, 7, 1, 0};
    std::memcpy(bytes.data() + header.description_offset, record.data(), sizeof record);
    const auto of_version = [&](std::uint32_t version) {
        return opened_with_header(bytes, [&](format::FileHeader& old) { old.version = version; });
    };
    EXPECT_EQ(of_version(3), ErrorCode::unsupported);
    EXPECT_EQ(of_version(0), ErrorCode::unsupported);
    ASSERT_EQ(of_version(1), ErrorCode::empty) << GridFile::open(path_).error().message;
    const auto old = GridFile::open(path_);
    EXPECT_TRUE(old->verify());
    EXPECT_EQ(old->description().provenance.stations, now.provenance.stations);
    EXPECT_EQ(old->description().provenance.parts, now.provenance.parts);
}

TEST_F(GridFileTest, AWindowThatContradictsItselfIsRefused) {
    ASSERT_TRUE(write(real_file_system()));
    const auto good = bytes_of(path_);
    const auto opened_with = [&](std::uint32_t features, double offset) {
        return opened_with_header(good, [&](format::FileHeader& header) {
            header.required_features = features;
            header.offset_y_cells = offset;
        });
    };
    EXPECT_EQ(opened_with(0, 0), ErrorCode::empty) << "the file is valid with these values";
    EXPECT_EQ(opened_with(1, 2.5), ErrorCode::empty);
    EXPECT_EQ(opened_with(0, 2.5), ErrorCode::corrupt);
    EXPECT_EQ(opened_with(1, 0), ErrorCode::corrupt);
    EXPECT_EQ(opened_with(1, 0.3), ErrorCode::corrupt) << "an offset must be a multiple of a half";
    EXPECT_EQ(opened_with(1, std::nan("")), ErrorCode::corrupt);
    EXPECT_EQ(opened_with(4, 0), ErrorCode::unsupported);
    EXPECT_EQ(opened_with(5, 2.5), ErrorCode::unsupported);
}

TEST_F(GridFileTest, AProjectionThatDoesNotFitItsNumbersIsCorrupt) {
    ASSERT_TRUE(write(real_file_system()));
    const auto good = bytes_of(path_);
    const auto opened_as = [&](std::uint32_t projection, double spacing) {
        return opened_with_header(good, [&](format::FileHeader& header) {
            header.projection = projection;
            header.spacing = spacing;
        });
    };
    EXPECT_EQ(opened_as(0, 1000), ErrorCode::empty) << "the file is valid with these values";
    EXPECT_EQ(opened_as(1, 0.01), ErrorCode::empty) << "the spacing is in degrees";
    EXPECT_EQ(opened_as(1, 1000), ErrorCode::corrupt) << "1000 degrees";
    EXPECT_EQ(opened_as(2, 1000), ErrorCode::corrupt) << "a cone needs parallels";
    EXPECT_EQ(opened_as(3, 1000), ErrorCode::corrupt);
    EXPECT_EQ(opened_as(0xFFFFFFFF, 1000), ErrorCode::corrupt);
}

TEST_F(GridFileTest, AGridThatWasNotAuditedHasNoRows) {
    grid::Grid grid = testing::small_grid();
    grid.provenance.audit.clear();
    const grid::BrickGrid made = grid::BrickGrid::from(grid, {});
    ASSERT_TRUE(write_grid_file(real_file_system(), path_, describe(grid), made.view()));
    const auto file = GridFile::open(path_);
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_TRUE(file->description().provenance.audit.empty());
}

// A file with impossible audit values can be written, but not opened.
TEST_F(GridFileTest, AnImpossibleAuditIsCorrupt) {
    const auto opened_with = [&](auto change) {
        grid::Grid grid = testing::small_grid();
        change(grid.provenance.audit.front());
        return opened_as_written(grid);
    };
    EXPECT_EQ(opened_with([](grid::AuditRow&) {}), ErrorCode::empty);
    EXPECT_EQ(opened_with([](grid::AuditRow& row) { row.rms = NAN; }), ErrorCode::corrupt);
    EXPECT_EQ(opened_with([](grid::AuditRow& row) { row.count = 951; }), ErrorCode::corrupt);
    EXPECT_EQ(opened_with([](grid::AuditRow& row) { row.range_to_m = 0; }), ErrorCode::corrupt);
}

TEST_F(GridFileTest, APartOnImpossibleColumnsIsCorrupt) {
    const auto opened_with = [&](grid::GridWindow window) {
        grid::Grid grid = testing::small_grid();
        grid.provenance.parts.front().window = window;
        return opened_as_written(grid);
    };
    EXPECT_EQ(opened_with({16383, 0, 1, 16384}), ErrorCode::empty);
    EXPECT_EQ(opened_with({16383, 0, 2, 1}), ErrorCode::corrupt);
    EXPECT_EQ(opened_with({-1, 0, 2, 1}), ErrorCode::corrupt);
    EXPECT_EQ(opened_with({0, 0, 2, 0}), ErrorCode::corrupt);
    EXPECT_EQ(opened_with({0, 1, 1, 2147483647}), ErrorCode::corrupt);
}

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

// Each byte before the codes gets one wrong bit, which changes either the checksum or protected
// data.
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
    EXPECT_TRUE(GridFile::open(path_)) << "the restored file can be opened";
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
