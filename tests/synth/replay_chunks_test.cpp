// Tests replays as chunks, with files kept open, and of several stations.
#include <algorithm>
#include <array>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "stormcellar/level2/chunk_directory.h"
#include "stormcellar/level2/volume_difference.h"
#include "synth/replay_pieces.h"
#include "tests/synth/replay_fixture.h"
#include "tests/testing/data.h"

namespace stormcellar::synth {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::vector<std::string> files_below(const fs::path& directory) {
    std::vector<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator(directory)) {
        if (entry.is_regular_file()) names.push_back(entry.path().lexically_relative(directory));
    }
    std::sort(names.begin(), names.end());
    return names;
}

TEST_F(Replay, ChunksHaveStationNumberTimeAndKindInTheirNames) {
    put("a", volume_of("KTLX", 1000, 2));
    put("b", wire::gzip(volume_of("KFTG", 2000, 1)));
    const auto report = play(at_once(Delivery::chunks));
    ASSERT_TRUE(report) << report.error().message;
    const std::string a = day_and_second(1), b = day_and_second(2);
    EXPECT_THAT(files_below(drop()),
                ElementsAre("KFTG/116/" + b + "-001-S", "KFTG/116/" + b + "-002-E",
                            "KTLX/116/" + a + "-001-S", "KTLX/116/" + a + "-002-I",
                            "KTLX/116/" + a + "-003-E"));
    EXPECT_EQ(report->files, 2U);
    EXPECT_EQ(report->writes, 5U);
    const auto again = play(at_once(Delivery::chunks));
    ASSERT_FALSE(again);
    EXPECT_THAT(again.error().message, HasSubstr("KTLX/116: exists already"));
}

TEST_F(Replay, AVolumeThatStopsHasNoEnd) {
    wire::Bytes bytes = volume_of("KTLX", 1000, 2);
    bytes.resize(piece_ends(bytes)[1]);
    put("a", bytes);
    ASSERT_TRUE(play(at_once(Delivery::chunks)));
    const std::string a = "KTLX/116/" + day_and_second(1);
    EXPECT_THAT(files_below(drop()), ElementsAre(a + "-001-S", a + "-002-I"));
}

TEST_F(Replay, WhatHasNoRecordsIsRefusedBeforeAnythingIsWritten) {
    put("a", volume_of("KTLX", 1000));
    put("b", wire::Bytes(100, std::byte{1}));
    const auto refused = play(at_once(Delivery::chunks));
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::bad_argument);
    EXPECT_TRUE(fs::is_empty(drop()));
}

TEST_F(Replay, ChunksOfRealVolumesAreTheVolume) {
    STORMCELLAR_NEED_DATA();
    const fs::path data = *testing::data_directory();
    for (const char* name :
         {"volumes/KLOT20220317_000842_V06", "volumes/KCRP20170826_044114.trimmed.ar2v",
          "volumes/Level2_TSTL_20220213_2357.ar2v", "sequence-kbgm/KBGM20050822_024414.gz"}) {
        const auto items_there = find_replay_items({data / name});
        ASSERT_TRUE(items_there);
        ASSERT_TRUE(replay(*items_there, drop(), real_file_system(), at_once(Delivery::chunks)));
        const ReplayItem& played = items_there->front();
        const auto chunks = level2::decode_chunk_directory(drop() / played.station /
                                                           std::to_string(played.number.value()));
        ASSERT_TRUE(chunks) << chunks.error().message;
        const auto whole = level2::decode_file(data / name);
        ASSERT_TRUE(whole);
        EXPECT_EQ(level2::difference(chunks->volume, whole->volume), "") << name;
        fs::remove_all(drop() / played.station);
    }
}

// Counts the descriptors of this process that lead into the drop directory.
std::size_t open_below(const fs::path& directory) {
    std::size_t open = 0;
    for (const auto& entry : fs::directory_iterator("/proc/self/fd")) {
        std::error_code ignored;
        const fs::path target = fs::read_symlink(entry.path(), ignored);
        if (target.native().starts_with(directory.native())) ++open;
    }
    return open;
}

TEST_F(Replay, OpenFilesStayOpenAndTheOldestAreClosed) {
    for (std::uint32_t i = 0; i < 40; ++i)
        put(fmt::format("v{}", i), volume_at(1000 * i));
    for (const auto& [delivery, most] : {std::pair{Delivery::open, most_open_files},
                                         std::pair{Delivery::growing, std::size_t{0}}}) {
        std::vector<std::size_t> counts;
        ReplayOptions options = at_once(delivery);
        options.replayed = [&](std::size_t) { counts.push_back(open_below(drop())); };
        ASSERT_TRUE(play(options));
        ASSERT_EQ(counts.size(), 40U);
        for (std::size_t i = 0; i < counts.size(); ++i)
            EXPECT_EQ(counts[i], std::min(i + 1, most));
        EXPECT_EQ(open_below(drop()), 0U) << "all files are closed at the end";
        fs::remove_all(drop());
        fs::create_directory(drop());
    }
}

TEST_F(Replay, StationsMix) {
    put("a", volume_of("KTLX", 0, 20));
    put("b", volume_of("KFTG", 1000, 20));
    ReplayOptions options;
    options.delivery = Delivery::growing;
    options.speed = 10'000;  // each volume takes 30 ms
    std::atomic<bool> stop{false};
    options.stop = &stop;
    // The first volume to end stops the replay while the other is half written.
    options.replayed = [&](std::size_t) { stop = true; };
    const auto report = play(options);
    ASSERT_TRUE(report);
    EXPECT_EQ(report->files, 1U);
    EXPECT_THAT(report->unfinished, ElementsAre(drop() / "b"));
    EXPECT_GT(fs::file_size(drop() / "b"), 0U);
}

}  // namespace
}  // namespace stormcellar::synth
