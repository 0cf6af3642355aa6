#include "synth/replay.h"

#include <fstream>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/synth/replay_fixture.h"
#include "tests/testing/waiting.h"

namespace stormcellar::synth {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST_F(Replay, PlaysByTheTimesInTheHeadersThenByName) {
    put("a", volume_at(3000));
    put("b", wire::gzip(volume_at(1000)));  // the header is inside the gzip
    put("day/c", volume_at(2000));
    put("z", {});
    put("noise", wire::Bytes(100, std::byte{1}));
    put(".hidden", volume_at(500));
    EXPECT_THAT(parts_of(items(), &ReplayItem::name), ElementsAre("b", "day/c", "a", "noise", "z"));
}

TEST_F(Replay, WhatIsNotThereOrTwiceThereIsNamed) {
    const auto missing = find_replay_items({directory_ / "nowhere"});
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().code, ErrorCode::not_found);
    EXPECT_THAT(missing.error().message, HasSubstr("nowhere"));
    EXPECT_FALSE(find_replay_items({directory_ / "in"})) << "the directory is empty";
    put("a", volume_at(1));
    put("other/a", volume_at(2));
    const auto twice = find_replay_items({directory_ / "in/a", directory_ / "in/other"});
    ASSERT_FALSE(twice);
    EXPECT_EQ(twice.error().code, ErrorCode::bad_argument);
    EXPECT_THAT(twice.error().message, HasSubstr("in/other/a"));
}

TEST_F(Replay, AllWaysDeliverTheSameBytes) {
    put("a", volume_at(1000, 3));
    put("day/b", wire::gzip(volume_at(2000)));
    put("empty", {});
    for (const Delivery delivery : {Delivery::whole, Delivery::growing, Delivery::open}) {
        const auto report = play(at_once(delivery));
        ASSERT_TRUE(report) << report.error().message;
        EXPECT_EQ(report->files, 3U);
        EXPECT_FALSE(report->stopped);
        std::uint64_t bytes = 0;
        for (const char* name : {"a", "day/b", "empty"}) {
            const auto expected = read_file(directory_ / "in" / name).value();
            bytes += expected.size();
            EXPECT_EQ(read_file(drop() / name).value(), expected) << name;
        }
        EXPECT_EQ(report->bytes, bytes);
        fs::remove_all(drop());
        fs::create_directory(drop());
    }
}

TEST_F(Replay, NothingIsWrittenOver) {
    put("a", volume_at(1000));
    put("b", volume_at(2000));
    std::ofstream(drop() / "b") << "mine";
    for (const Delivery delivery : {Delivery::whole, Delivery::growing}) {
        const auto report = play(at_once(delivery));
        ASSERT_FALSE(report);
        EXPECT_THAT(report.error().message, HasSubstr("drop/b: exists already"));
        EXPECT_FALSE(fs::exists(drop() / "a"))
            << "the conflict is found before anything is written";
        EXPECT_EQ(fs::file_size(drop() / "b"), 4U);
    }
    const auto nowhere =
        replay(items(), directory_ / "none", real_file_system(), at_once(Delivery::whole));
    ASSERT_FALSE(nowhere);
    EXPECT_EQ(nowhere.error().code, ErrorCode::not_found);
}

TEST_F(Replay, StoppedInTheMiddleOfAFileItIsNamedAsUnfinished) {
    put("a", volume_at(1000, 8));
    put("b", volume_at(2000));
    std::atomic<bool> stop{false};
    ReplayOptions options = at_once(Delivery::growing);
    options.interval_s = 3600;  // an hour over nine pieces
    options.stop = &stop;
    std::thread watcher([&] {
        EXPECT_TRUE(testing::eventually([&] { return fs::exists(drop() / "a"); }));
        stop = true;
    });
    const auto report = play(options);
    watcher.join();
    ASSERT_TRUE(report);
    EXPECT_TRUE(report->stopped);
    EXPECT_EQ(report->files, 0U);
    EXPECT_THAT(report->unfinished, ElementsAre(drop() / "a"));
    EXPECT_LT(fs::file_size(drop() / "a"), fs::file_size(directory_ / "in/a"));
}

TEST_F(Replay, StoppedBetweenFilesNothingIsUnfinished) {
    put("a", volume_at(1000, 3));
    put("b", volume_at(2000));
    std::atomic<bool> stop{false};
    ReplayOptions options = at_once(Delivery::growing);
    options.stop = &stop;
    options.replayed = [&](std::size_t) { stop = true; };
    const auto after_one = play(options);
    ASSERT_TRUE(after_one);
    EXPECT_TRUE(after_one->stopped);
    EXPECT_EQ(after_one->files, 1U);
    EXPECT_THAT(after_one->unfinished, IsEmpty());
    EXPECT_FALSE(fs::exists(drop() / "b"));
}

// Headers are 500 ms apart, so the third file is not due yet when the second file is.
TEST_F(Replay, WhatIsPastIsWrittenBeforeItBegins) {
    put("a", volume_at(1000));
    put("b", volume_at(1500));
    put("c", volume_at(2000));
    ReplayOptions options;
    options.past_s = 0.75;
    std::vector<std::string> ended, past;
    options.ended = [&](const ReplayItem& item) { ended.push_back(item.name); };
    options.begun = [&] { past = ended; };
    const auto report = play(options);
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_THAT(past, ElementsAre("a", "b"));
    EXPECT_THAT(ended, ElementsAre("a", "b", "c"));
}

TEST_F(Replay, FilesAreWrittenAsTheyAreStamped) {
    put("a", volume_at(1000, 3));
    const auto source = read_file(directory_ / "in/a").value();
    for (const Delivery delivery : {Delivery::whole, Delivery::growing, Delivery::open}) {
        ReplayOptions options = at_once(delivery);
        options.stamp = [](const ReplayItem& item, std::span<std::byte> bytes) {
            EXPECT_EQ(item.name, "a");
            bytes[0] = std::byte{'X'};
        };
        ASSERT_TRUE(play(options));
        auto expected = source;
        expected[0] = std::byte{'X'};
        EXPECT_EQ(read_file(drop() / "a").value(), expected);
        fs::remove_all(drop() / "a");
    }
}

TEST_F(Replay, TimeBetweenFilesComesFromTheirHeadersOrTheInterval) {
    put("a", volume_at(0));
    put("b", volume_at(3'600'000));
    std::atomic<bool> stop{false};
    double wait_s = 0;
    ReplayOptions options;
    options.stop = &stop;
    options.waits = [&](double seconds, const fs::path& source) {
        EXPECT_EQ(source, directory_ / "in/b");
        wait_s = seconds;
        stop = true;
    };
    options.speed = 5;
    ASSERT_TRUE(play(options));
    // The expected wait is an hour, five times faster, less the time that the first file took.
    EXPECT_LE(wait_s, 720);
    EXPECT_GT(wait_s, 600);
    stop = false;
    fs::remove(drop() / "a");
    options.interval_s = 1800;
    ASSERT_TRUE(play(options));
    EXPECT_LE(wait_s, 1800);
    EXPECT_GT(wait_s, 1500);
}

}  // namespace
}  // namespace stormcellar::synth
