#include "synth/replay_pieces.h"

#include <algorithm>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "level2/containers/archive_header.h"
#include "stormcellar/base/file_system.h"
#include "tests/level2/wire.h"
#include "tests/testing/data.h"

namespace stormcellar::synth {
namespace {

namespace fs = std::filesystem;
namespace wire = level2::wire;
using ::testing::ElementsAre;
using ::testing::SizeIs;

TEST(ReplayPieces, AreLdmRecordsTheFirstWithTheHeader) {
    const wire::Bytes header = wire::archive_header();
    const wire::Bytes first = wire::ldm_record(wire::radial_messages(1, 2));
    const wire::Bytes second = wire::ldm_record(wire::radial_messages(2, 3), true);
    const std::size_t end = header.size() + first.size();
    EXPECT_THAT(piece_ends(wire::join({header, first, second})),
                ElementsAre(end, end + second.size()));
    EXPECT_THAT(piece_ends(wire::join({first, second})),
                ElementsAre(first.size(), first.size() + second.size()));
}

TEST(ReplayPieces, WhatHasNoRecordsComesInSixteenths) {
    EXPECT_THAT(piece_ends(wire::Bytes(1600)), SizeIs(16));
    EXPECT_EQ(piece_ends(wire::Bytes(1600)).front(), 100U);
    EXPECT_EQ(piece_ends(wire::Bytes(1600)).back(), 1600U);
    EXPECT_THAT(piece_ends(wire::Bytes(3)), ElementsAre(1, 2, 3));
    EXPECT_THAT(piece_ends({}), SizeIs(::testing::Le(1))) << "an empty file has at most one piece";
}

TEST(ReplayPieces, OfRealVolumesAreTheirChunks) {
    STORMCELLAR_NEED_DATA();
    const fs::path set = *testing::data_directory() / "chunks/KLOT_34";
    std::vector<fs::path> chunks;
    for (const auto& entry : fs::directory_iterator(set))
        chunks.push_back(entry.path());
    std::sort(chunks.begin(), chunks.end());
    wire::Bytes whole;
    std::vector<std::size_t> ends;
    for (const fs::path& chunk : chunks) {
        const auto bytes = read_file(chunk).value();
        whole.insert(whole.end(), bytes.begin(), bytes.end());
        ends.push_back(whole.size());
    }
    EXPECT_EQ(piece_ends(whole), ends);
}

TEST(ReplayPieces, AHeaderInTheMidstBeginsOne) {
    const wire::Bytes header = wire::archive_header();
    const wire::Bytes record = wire::ldm_record(wire::radial_messages(1, 2));
    const std::size_t first = header.size() + record.size();
    EXPECT_THAT(piece_ends(wire::join({header, record, header, record, record})),
                ElementsAre(first, 2 * first, 2 * first + record.size()));
}

TEST(ReplayPieces, TheLastControlWordSaysWhetherTheVolumeEnds) {
    const wire::Bytes header = wire::archive_header();
    const wire::Bytes record = wire::ldm_record(wire::radial_messages(1, 2));
    const wire::Bytes last = wire::ldm_record(wire::radial_messages(2, 3), true);
    EXPECT_TRUE(ends_volume(wire::join({header, record, last})));
    EXPECT_FALSE(ends_volume(wire::join({header, record})));
    EXPECT_FALSE(ends_volume(wire::join({header, last, record}))) << "only the last record counts";
    EXPECT_FALSE(ends_volume({}));
}

TEST(ReplayPieces, RecordsAreSeenBehindAHeaderOrAtTheStart) {
    const wire::Bytes record = wire::ldm_record(wire::radial_messages(1, 2));
    EXPECT_TRUE(has_ldm_records(record));
    EXPECT_TRUE(has_ldm_records(wire::join({wire::archive_header(), record})));
    EXPECT_FALSE(has_ldm_records(wire::archive_header()));
    EXPECT_FALSE(has_ldm_records(wire::gzip(record)));
    EXPECT_FALSE(has_ldm_records({}));
}

}  // namespace
}  // namespace stormcellar::synth
