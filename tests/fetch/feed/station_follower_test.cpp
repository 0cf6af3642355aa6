// Follows a station with a simulated clock, in a bucket in memory, through everything that may
// happen in a bucket.
#include "fetch/feed/station_follower.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/fetch/feed/made_keys.h"

namespace stormcellar::feed {
namespace {

using std::chrono::minutes;
using std::chrono::seconds;

const UtcTime start = *parse_utc("2026-11-28T12:00:00Z", {});

// Asks as StationFeed does. Each turn requests one listing, and then all new chunks in it.
class Following : public ::testing::Test {
  protected:
    void begin(const std::vector<VolumeId>& written = {}) {
        follower_ = std::make_unique<StationFollower>("KTLX", written, steady_);
    }
    // Asks `turns` times, four seconds apart. Returns the new chunks in the order in which they
    // came.
    std::vector<std::string> turns(int turns) {
        std::vector<std::string> came;
        for (int i = 0; i < turns; ++i) {
            const auto question = follower_->question(steady_, steady_ - news_ >= seconds{60});
            questions_.push_back(question.prefix);
            auto news = follower_->take(listed(keys_, question), start + elapsed_, steady_);
            for (const auto& chunk : news.chunks) {
                came.push_back(to_string(chunk.key));
                follower_->note_done(chunk.key);
            }
            if (!news.chunks.empty()) news_ = steady_;
            if (news.is_urgent) continue;
            steady_ += seconds{4};
            elapsed_ += seconds{4};
        }
        return came;
    }
    // Asks again and again until no more chunks come. Returns the new chunks in the order in which
    // they came.
    std::vector<std::string> all() {
        std::vector<std::string> came;
        for (int quiet = 0; quiet < 12;) {
            auto more = turns(1);
            quiet = more.empty() ? quiet + 1 : 0;
            std::ranges::move(more, std::back_inserter(came));
        }
        return came;
    }
    [[nodiscard]] static std::string key(int volume, UtcTime time, int number, char kind = 'I') {
        return key_of("KTLX", volume, time, number, kind);
    }
    [[nodiscard]] std::vector<std::string> sorted_keys() const {
        return {keys_.begin(), keys_.end()};
    }

    std::set<std::string> keys_;
    std::vector<std::string> questions_;  // prefixes of the questions
    std::unique_ptr<StationFollower> follower_;
    SteadyTime steady_ = steady_now(), news_ = steady_;
    seconds elapsed_{0};
};

TEST_F(Following, BeginsWithTheVolumeBeforeTheNewestAndGoesOn) {
    add_volume(keys_, 493, start - minutes{15}, 5);
    add_volume(keys_, 494, start - minutes{10}, 5);
    add_volume(keys_, 495, start - minutes{5}, 3, false);
    begin();
    const auto came = all();
    ASSERT_EQ(came.size(), 8U);
    EXPECT_EQ(came.front(), key(494, start - minutes{10}, 1, 'S'));
    EXPECT_EQ(came.back(), key(495, start - minutes{5}, 3));
    add_volume(keys_, 495, start - minutes{5}, 5, true);
    EXPECT_EQ(turns(4),
              (std::vector{key(495, start - minutes{5}, 4), key(495, start - minutes{5}, 5, 'E')}));
    add_volume(keys_, 496, start, 1);
    EXPECT_EQ(turns(2), std::vector{key(496, start, 1, 'S')});
    EXPECT_EQ(follower_->missing(), 0U);
}

TEST_F(Following, AChunkThatComesLateIsTaken) {
    begin({{start, 494}});
    add_volume(keys_, 494, start, 6);
    keys_.erase(key(494, start, 3));
    EXPECT_EQ(turns(1).size(), 5U);
    EXPECT_EQ(turns(3).size(), 0U);
    keys_.insert(key(494, start, 3));
    EXPECT_EQ(turns(4), std::vector{key(494, start, 3)});
}

TEST_F(Following, AChunkThatComesAfterTheNextVolumeBeganIsTaken) {
    begin({{start, 494}});
    add_volume(keys_, 494, start, 6);
    keys_.erase(key(494, start, 3));
    (void)turns(2);
    add_volume(keys_, 495, start + minutes{5}, 2, false);
    EXPECT_EQ(all().size(), 2U) << "the next volume does not wait for the missing chunks";
    keys_.insert(key(494, start, 3));
    EXPECT_EQ(turns(4), std::vector{key(494, start, 3)});
    EXPECT_EQ(follower_->missing(), 0U);
}

TEST_F(Following, AChunkThatNeverComesIsCounted) {
    begin({{start, 494}});
    add_volume(keys_, 494, start, 6);
    keys_.erase(key(494, start, 3));
    keys_.erase(key(494, start, 6, 'E'));
    add_volume(keys_, 495, start + minutes{5}, 6);
    EXPECT_EQ(all().size(), 10U);
    (void)turns(20);
    EXPECT_EQ(follower_->missing(), 2U) << "number 3 and the end are missing";
    EXPECT_LE(std::ranges::count(questions_, "KTLX/494/"), 12)
        << "the old volume is listed for another minute";
}

TEST_F(Following, AnEndThatNeverComesHoldsUpNothing) {
    begin({{start, 494}});
    add_volume(keys_, 494, start, 5, false);
    (void)turns(3);
    add_volume(keys_, 495, start + minutes{5}, 1, false);
    EXPECT_EQ(turns(4), std::vector{key(495, start + minutes{5}, 1, 'S')})
        << "the chunk comes within 16 seconds";
}

TEST_F(Following, AfterNumber999ComesNumber1) {
    add_volume(keys_, 1, start - minutes{999 * 5}, 5);  // an older volume with number 1
    begin({{start, 999}});
    add_volume(keys_, 999, start, 5);
    EXPECT_EQ(all().size(), 5U) << "the chunks of the last round must not be taken";
    add_volume(keys_, 1, start + minutes{5}, 3, false);
    EXPECT_EQ(all().front(), key(1, start + minutes{5}, 1, 'S'));
}

TEST_F(Following, TwoVolumesInOneSecondAreTwo) {
    begin({{start, 494}});
    add_volume(keys_, 494, start, 4, false);
    add_volume(keys_, 495, start, 4);
    EXPECT_EQ(all(), sorted_keys());
}

TEST_F(Following, TwoVolumesInOneDirectoryAreTwo) {
    begin({{start, 494}});
    add_volume(keys_, 494, start, 4, false);
    add_volume(keys_, 494, start + seconds{40}, 4);
    add_volume(keys_, 495, start + minutes{5}, 4);
    EXPECT_EQ(all(), sorted_keys());
}

TEST_F(Following, OneNumberIsTakenOnce) {
    begin({{start, 494}});
    add_volume(keys_, 494, start, 4, false);
    keys_.insert(key(494, start, 4, 'E'));
    EXPECT_EQ(all().size(), 4U);
    EXPECT_EQ(follower_->chunk(), 4);
}

TEST_F(Following, AClockThatIsSetBackHoldsUpNothing) {
    begin({{start, 494}});
    add_volume(keys_, 494, start, 4);
    add_volume(keys_, 495, start - minutes{20}, 4);
    EXPECT_EQ(all().size(), 8U);
}

TEST_F(Following, AVolumeThatNeverCameIsPassedOver) {
    begin({{start, 494}});
    add_volume(keys_, 494, start, 4);
    (void)turns(20);
    add_volume(keys_, 496, start + minutes{10}, 4);
    EXPECT_EQ(turns(8).size(), 4U);
}

TEST_F(Following, AStationThatBeginsAtNumber1AgainIsFound) {
    for (int number = 1; number <= 999; ++number)
        add_volume(keys_, number, start - minutes{5 * (500 - number + (number > 500 ? 999 : 0))},
                   2);
    begin({{start, 500}});
    (void)turns(20);
    std::erase_if(keys_, [](const std::string& one) { return one.starts_with("KTLX/1/"); });
    add_volume(keys_, 1, start + minutes{5}, 4);
    EXPECT_EQ(turns(10).size(), 4U);
    add_volume(keys_, 2, start + minutes{10}, 4);
    EXPECT_EQ(all().size(), 4U);
}

TEST_F(Following, AStationThatWentOnAnywhereIsFound) {
    begin({{start, 500}});
    add_volume(keys_, 500, start, 4);
    (void)all();
    for (int i = 0; i < 14; ++i)
        add_volume(keys_, 700 + i, start + minutes{5 * i + 5}, 4);
    elapsed_ += minutes{80};
    EXPECT_GE(turns(600).size(), 4U) << "the follower goes around the ring in steps of 13";
}

TEST_F(Following, JunkIsLeftOut) {
    begin({{start, 494}});
    add_volume(keys_, 494, start, 3);
    const std::set<std::string> good = keys_;
    for (const char* junk : {"KTLX/494/../../../etc/20261128-120000-004-I", "KTLX/494/x",
                             "KTLX/494/29991231-000000-001-S", "KTLX/494/20261128-120000-004-Q"})
        keys_.insert(junk);
    EXPECT_EQ(all(), (std::vector<std::string>{good.begin(), good.end()}));
}

TEST_F(Following, WhatWasNotAskedIsLeftOut) {
    begin({{start, 494}});
    const auto question = follower_->question(steady_, false);
    fetch::ListingPage lies;
    for (const char* text : {"KFDR/494/20261128-120000-001-S", "KTLX/493/20261128-120000-001-S",
                             "KTLX/494/20261128-115959-001-S"})
        lies.objects.push_back({text, made_size, std::nullopt, {}});
    EXPECT_EQ(question.prefix, "KTLX/494/");
    EXPECT_TRUE(follower_->take(lies, start, steady_).chunks.empty());
}

TEST_F(Following, GoesOnWithTheVolumesOfTheDropDirectory) {
    add_volume(keys_, 494, start, 4);
    add_volume(keys_, 495, start + minutes{5}, 4);
    begin({{start, 494}, {start + minutes{5}, 495}});
    EXPECT_EQ(all().size(), 8U)
        << "the listings of both volumes are compared with the written chunks";
    EXPECT_EQ(std::ranges::count(questions_, "KTLX/"), 0) << "no search takes place";
}

}  // namespace
}  // namespace stormcellar::feed
