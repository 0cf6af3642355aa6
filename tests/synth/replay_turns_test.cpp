#include "synth/replay_turns.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/synth/replay_fixture.h"

namespace stormcellar::synth {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

ReplayItem item(std::string station, std::optional<int> seconds, std::optional<int> number = {}) {
    ReplayItem made;
    made.name = made.source = fmt::format("{}-{}", station, seconds.value_or(-1));
    made.station = std::move(station);
    if (seconds) made.time = UtcTime{std::chrono::seconds{1'000'000 + *seconds}};
    made.number = number;
    made.has_records = true;
    return made;
}

std::vector<std::pair<double, double>> starts_and_spans(const std::vector<ReplayItem>& items,
                                                        const ReplayOptions& options) {
    std::vector<std::pair<double, double>> all;
    for (const ReplayTurn& turn : turns_of(items, options))
        all.emplace_back(turn.start_s, turn.span_s);
    return all;
}

using Turn = std::pair<double, double>;

TEST(ReplayTurns, AVolumeLastsUntilItsStationsNext) {
    const std::vector<ReplayItem> items = {item("KTLX", 0), item("KFTG", 100), item("KTLX", 240),
                                           item("KFTG", 500), item("KTLX", 2000)};
    EXPECT_THAT(starts_and_spans(items, {}),
                ElementsAre(Turn(0, 240), Turn(100, 400), Turn(240, longest_volume_s),
                            Turn(500, 400), Turn(2000, longest_volume_s)));
    ReplayOptions fast;
    fast.speed = 10;
    EXPECT_THAT(starts_and_spans(items, fast),
                ElementsAre(Turn(0, 24), Turn(10, 40), Turn(24, longest_volume_s / 10),
                            Turn(50, 40), Turn(200, longest_volume_s / 10)));
}

TEST(ReplayTurns, AnOnlyVolumeLastsAsUsualAndOneWithoutTimeComesLastAtOnce) {
    EXPECT_THAT(starts_and_spans({item("KTLX", 0), item("KFTG", 50), item("", {})}, {}),
                ElementsAre(Turn(0, usual_volume_s), Turn(50, usual_volume_s), Turn(50, 0)));
    EXPECT_THAT(starts_and_spans({item("", {})}, {}), ElementsAre(Turn(0, 0)));
}

TEST(ReplayTurns, AnIntervalPutsOneBehindTheOther) {
    ReplayOptions options;
    options.interval_s = 2;
    EXPECT_THAT(starts_and_spans({item("KTLX", 0), item("KFTG", 0), item("KTLX", 7)}, options),
                ElementsAre(Turn(0, 2), Turn(2, 2), Turn(4, 2)));
}

// 2026-11-22: the replay of an archive of several years waited for days without a message.
TEST(ReplayPlan, SaysWhichTimesAndHowLong) {
    const std::vector<ReplayItem> items = {item("KTLX", 0), item("KFTG", 100),
                                           item("KTLX", 157'680'000), item("", {})};
    ReplayOptions options;
    options.speed = 400;
    const ReplayPlan plan = plan_replay(items, options);
    EXPECT_EQ(plan.files, 4U);
    EXPECT_EQ(plan.first, items[0].time);
    EXPECT_EQ(plan.last, items[2].time);
    EXPECT_DOUBLE_EQ(plan.takes_s, 157'680'000 / 400.0);
    options.delivery = Delivery::growing;
    EXPECT_DOUBLE_EQ(plan_replay(items, options).takes_s, (157'680'000 + longest_volume_s) / 400.0);
    options.interval_s = 2;
    EXPECT_DOUBLE_EQ(plan_replay(items, options).takes_s, 8);
    EXPECT_FALSE(plan_replay({item("", {})}, options).first);
    EXPECT_EQ(plan_replay({}, options).takes_s, 0);
}

TEST(ReplayTurns, ChunksLieByStationAndNumberEachVolumeInItsOwn) {
    const auto targets = targets_of({item("KTLX", 0, 998), item("KFTG", 0, 998),
                                     item("KTLX", 9, 998), item("KTLX", 12, 998), item("KTLX", 20)},
                                    Delivery::chunks);
    ASSERT_TRUE(targets);
    EXPECT_THAT(*targets, ElementsAre("KTLX/998", "KFTG/998", "KTLX/999", "KTLX/0", "KTLX/1"));
    EXPECT_THAT(targets_of({item("KTLX", 7)}, Delivery::open).value(), ElementsAre("KTLX-7"));
}

TEST(ReplayTurns, WhatCannotComeInChunksIsNamed) {
    ReplayItem plain = item("KTLX", 0);
    plain.has_records = false;
    for (const ReplayItem& wrong : {plain, item("KTLX", {}), item("", 0)}) {
        const auto refused = targets_of({wrong}, Delivery::chunks);
        ASSERT_FALSE(refused);
        EXPECT_EQ(refused.error().code, ErrorCode::bad_argument);
        EXPECT_THAT(refused.error().message, HasSubstr("cannot come in chunks"));
        EXPECT_TRUE(targets_of({wrong}, Delivery::growing));
    }
}

}  // namespace
}  // namespace stormcellar::synth
