#include "cache/account.h"

#include <algorithm>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cache/made_grids.h"

namespace stormcellar::cache {
namespace {

using std::chrono::hours;
using std::chrono::milliseconds;
using std::chrono::minutes;
using ::testing::ElementsAre;
using testing::grid_named;
using ::testing::IsEmpty;
using testing::noon;

// Times are in minutes after noon.
class AccountTest : public ::testing::Test {
  protected:
    AccountTest() { account_.set_now(noon + hours{24}); }
    void put(const std::string& domain, int minute, std::uint64_t bytes = 10, bool pinned = false) {
        account_.put(grid_named(domain, minute), {bytes, noon, pinned});
    }
    [[nodiscard]] auto room(const GridName& grid, std::uint64_t bytes) const {
        return account_.room_for(grid, bytes, budgets_);
    }
    Account account_;
    Budgets budgets_;
};

TEST_F(AccountTest, TakesTheOldestOfAllForTheTotalAndOfTheGroupForItsOwn) {
    for (int minute = 0; minute < 4; ++minute) {
        put("A", 2 * minute);
        put("B", 2 * minute + 1);
    }
    EXPECT_EQ(account_.used(), 80U);
    EXPECT_EQ(account_.used("A"), 40U);
    EXPECT_THAT(account_.down_to("", 60, 100), ElementsAre(grid_named("A", 0), grid_named("B", 1)));
    EXPECT_THAT(account_.down_to("B", 20, 100),
                ElementsAre(grid_named("B", 1), grid_named("B", 3)));
    EXPECT_THAT(account_.down_to("B", 0, 2), ElementsAre(grid_named("B", 1), grid_named("B", 3)));

    budgets_.total.bytes = 80;
    budgets_.domains["B"].bytes = 45;
    EXPECT_FALSE(account_.fits("B", 10, budgets_));
    EXPECT_TRUE(account_.fits("B", 0, budgets_));
    // The group's own budget needs 5 bytes, and the total budget 10. A grid that is evicted for one
    // of the two budgets also gives room in the other budget.
    EXPECT_THAT(*room(grid_named("B", 9), 10), ElementsAre(grid_named("B", 1)));
    EXPECT_THAT(*room(grid_named("B", 9), 20), ElementsAre(grid_named("B", 1), grid_named("B", 3)));
    EXPECT_THAT(*room(grid_named("A", 9), 20), ElementsAre(grid_named("A", 0), grid_named("B", 1)));
    EXPECT_THAT(*room(grid_named("B", 9), 15), ElementsAre(grid_named("B", 1), grid_named("A", 0)));
    EXPECT_FALSE(room(grid_named("B", 9), 46)) << "the grid exceeds the group's budget";
}

TEST_F(AccountTest, NeverTakesTheNewestOfADomainAndMoment) {
    put("A", 0);
    put("A", 1);
    put("B", 2);
    account_.put({"A", level2::Moment::vel, noon}, {10, noon, false});
    EXPECT_THAT(account_.down_to("", 0, 100), ElementsAre(grid_named("A", 0)));
    account_.reserve("C", 20);
    budgets_.total.bytes = 60;
    EXPECT_THAT(*room(grid_named("C", 3), 10), ElementsAre(grid_named("A", 0)));
    EXPECT_FALSE(room(grid_named("C", 3), 11)) << "no other grid may be evicted";
    // The newest grid of a domain stays until there is a newer one.
    EXPECT_THAT(*room(grid_named("B", 3), 10), ElementsAre(grid_named("A", 0)));
}

TEST_F(AccountTest, MakesRoomForOldGridsOnlyFromOlderOnes) {
    put("A", 10);
    put("A", 20);
    put("A", 30);
    budgets_.total.bytes = 30;
    EXPECT_FALSE(room(grid_named("A", 5), 10)) << "the new grid would be the oldest";
    EXPECT_THAT(*room(grid_named("A", 15), 10), ElementsAre(grid_named("A", 10)));
    EXPECT_FALSE(room(grid_named("A", 15), 20));
    // But the only grid of a domain is its newest grid, even if it is old.
    EXPECT_THAT(*room(grid_named("B", -500), 10), ElementsAre(grid_named("A", 10)));
}

TEST_F(AccountTest, LeavesPinnedBusyAndStuckOnes) {
    for (int minute = 0; minute < 6; ++minute)
        put("A", minute, 10, minute == 0);
    account_.set_busy(grid_named("A", 1));
    account_.set_stuck(grid_named("A", 2));
    EXPECT_EQ(account_.pinned_count(), 1U);
    EXPECT_THAT(account_.down_to("", 0, 100), ElementsAre(grid_named("A", 3), grid_named("A", 4)));
    account_.set_pinned(grid_named("A", 3));
    EXPECT_EQ(account_.pinned_count(), 2U);
    EXPECT_THAT(account_.down_to("", 0, 100), ElementsAre(grid_named("A", 4)));
    put("A", 1);
    put("A", 2);
    EXPECT_THAT(account_.down_to("", 0, 2), ElementsAre(grid_named("A", 1), grid_named("A", 2)));
}

TEST_F(AccountTest, WhatIsLeavingIsCountedAndNotTakenTwice) {
    for (int minute = 0; minute < 4; ++minute)
        put("A", minute);
    budgets_.total.bytes = 40;
    account_.set_leaving(grid_named("A", 0));
    EXPECT_EQ(account_.used(), 40U);
    EXPECT_FALSE(account_.fits("A", 10, budgets_)) << "the leaving grid still counts";
    EXPECT_THAT(*room(grid_named("A", 9), 10), IsEmpty()) << "the leaving grid makes enough room";
    EXPECT_THAT(*room(grid_named("A", 9), 20), ElementsAre(grid_named("A", 1)));
    EXPECT_THAT(account_.down_to("", 20, 100), ElementsAre(grid_named("A", 1)));
    account_.erase(grid_named("A", 0));
    EXPECT_TRUE(account_.fits("A", 10, budgets_));
}

TEST_F(AccountTest, ReservedBytesCount) {
    put("A", 0);
    put("A", 1);
    account_.reserve("A", 15);
    EXPECT_EQ(account_.used(), 35U);
    EXPECT_EQ(account_.used("A"), 35U);
    budgets_.every_domain.bytes = 40;
    EXPECT_TRUE(account_.fits("A", 5, budgets_));
    EXPECT_FALSE(account_.fits("A", 6, budgets_));
    account_.release("A", 15);
    EXPECT_TRUE(account_.fits("A", 20, budgets_));
    EXPECT_EQ(account_.used(), 20U);
}

// Age counts from the newest grid of a group, not from the clock.
TEST_F(AccountTest, AgeCountsFromTheNewestOfTheGroup) {
    for (const int minute : {0, 30, 60, 90})
        put("A", minute);
    put("B", 0);
    put("B", 10);
    budgets_.total.age = minutes{60};
    EXPECT_THAT(account_.expired("A", budgets_, 100), ElementsAre(grid_named("A", 0)));
    EXPECT_THAT(account_.expired("B", budgets_, 100), IsEmpty());
    budgets_.domains["A"].age = minutes{20};
    EXPECT_THAT(account_.expired("A", budgets_, 100),
                ElementsAre(grid_named("A", 0), grid_named("A", 30), grid_named("A", 60)));
    EXPECT_THAT(account_.expired("A", budgets_, 1), ElementsAre(grid_named("A", 0)));
    EXPECT_TRUE(account_.is_expired(grid_named("A", 69), budgets_));
    EXPECT_FALSE(account_.is_expired(grid_named("A", 70), budgets_));
    EXPECT_FALSE(account_.is_expired(grid_named("C", -9000), budgets_));
    // The time of the clock does not matter.
    account_.set_now(noon + hours{24 * 3650});
    EXPECT_THAT(account_.expired("B", budgets_, 100), IsEmpty());
}

// Grids more than 10 minutes in the future do not make other grids old.
TEST_F(AccountTest, StampsInTheFutureMakeNothingOld) {
    account_.set_now(noon);
    budgets_.total.age = minutes{60};
    put("A", -30);
    put("A", 0);
    put("A", 10);
    EXPECT_EQ(account_.newest("A"), noon + minutes{10});
    account_.put(grid_named("A", 11), {10, noon, false});
    account_.put(grid_named("A", 60 * 24 * 365), {10, noon + minutes{1}, false});
    EXPECT_EQ(account_.newest("A"), noon + minutes{10});
    EXPECT_THAT(account_.expired("A", budgets_, 100), IsEmpty());
    // Grids in the future count as old as their files, so they are evicted like other grids.
    EXPECT_TRUE(account_.is_newest(grid_named("A", 10)));
    EXPECT_THAT(account_.down_to("A", 0, 100),
                ElementsAre(grid_named("A", -30), grid_named("A", 0), grid_named("A", 11),
                            grid_named("A", 60 * 24 * 365)));
    // A minute later, the time of one of these grids is believable.
    account_.set_now(noon + minutes{1});
    EXPECT_EQ(account_.newest("A"), noon + minutes{11});
    EXPECT_THAT(account_.down_to("A", 0, 100),
                ElementsAre(grid_named("A", -30), grid_named("A", 0),
                            grid_named("A", 60 * 24 * 365), grid_named("A", 10)));
}

TEST_F(AccountTest, ADomainOfFutureStampsAloneKeepsItsNewest) {
    account_.set_now(noon);
    put("A", 100);
    put("A", 200);
    EXPECT_EQ(account_.newest("A"), std::nullopt);
    EXPECT_THAT(account_.down_to("", 0, 100), ElementsAre(grid_named("A", 100)));
}

TEST_F(AccountTest, PartsAreCountedWithTheirDomain) {
    put("northeast", 60);
    put("northeast.KBOX", 0);
    put("northeast.KBOX", 50);
    put("northeast.KOKX", 5);
    put("north", 0);
    EXPECT_EQ(account_.used("northeast"), 40U);
    EXPECT_EQ(account_.newest("northeast"), noon + minutes{60});
    EXPECT_THAT(account_.down_to("northeast", 0, 100),
                ElementsAre(grid_named("northeast.KBOX", 0)));
    // If no more partials of a site come, even its newest partial expires.
    budgets_.domains["northeast"].age = minutes{30};
    EXPECT_THAT(account_.expired("northeast", budgets_, 100),
                ElementsAre(grid_named("northeast.KBOX", 0), grid_named("northeast.KOKX", 5)));
}

TEST_F(AccountTest, AFullDiskTakesTheOldestWhereABudgetLimitsSpace) {
    for (const int minute : {0, 1}) {
        put("A", minute);
        put("B", minute + 5);
    }
    budgets_.domains["B"].bytes = 1000;
    EXPECT_FALSE(budgets_.makes_room("A"));
    EXPECT_TRUE(budgets_.makes_room("B"));
    EXPECT_THAT(account_.oldest(grid_named("B", 9), 10, budgets_), ElementsAre(grid_named("B", 5)));
    EXPECT_THAT(account_.oldest(grid_named("B", 9), 100, budgets_),
                ElementsAre(grid_named("B", 5)));
    budgets_.total.file_system_percent = 90;
    EXPECT_THAT(account_.oldest(grid_named("B", 9), 11, budgets_),
                ElementsAre(grid_named("A", 0), grid_named("B", 5)));
    EXPECT_THAT(account_.oldest(grid_named("B", 3), 11, budgets_), ElementsAre(grid_named("A", 0)))
        << "only older grids may be evicted";
}

// A pinned grid that is written again may take the room of newer grids, because it stays anyway.
TEST_F(AccountTest, AGridToStayMayTakeTheRoomOfNewerOnes) {
    put("A", 0, 10, true);
    put("A", 1);
    put("A", 2);
    budgets_.total.bytes = 30;
    EXPECT_TRUE(account_.is_to_stay(grid_named("A", 0)));
    EXPECT_FALSE(account_.is_to_stay(grid_named("A", 1)));
    EXPECT_THAT(*room(grid_named("A", 0), 10), ElementsAre(grid_named("A", 1)));
    budgets_.total.age = std::chrono::seconds{1};
    EXPECT_FALSE(account_.is_expired(grid_named("A", 0), budgets_));
    EXPECT_TRUE(account_.is_expired(grid_named("A", 1), budgets_));
}

// After random changes, sums and choices agree with an obvious implementation.
TEST_F(AccountTest, AgreesWithAListThatIsSortedEachTime) {
    std::mt19937 random(7);
    const auto draw = [&](int end) {
        return static_cast<int>(random() % static_cast<unsigned>(end));
    };
    std::map<GridName, GridFacts> slow;
    for (int step = 0; step < 3000; ++step) {
        const GridName grid = grid_named(
            std::vector<std::string>{"A", "B", "B.KBOX"}.at(static_cast<std::size_t>(draw(3))),
            draw(60));
        if (draw(3) == 0) {
            account_.erase(grid);
            slow.erase(grid);
        } else {
            const GridFacts facts{static_cast<std::uint64_t>(draw(100)), noon, draw(8) == 0};
            account_.put(grid, facts);
            slow[grid] = facts;
        }
        std::uint64_t sum = 0;
        std::vector<std::pair<UtcTime, GridName>> order;
        for (const auto& [key, facts] : slow) {
            sum += facts.bytes;
            const auto next = slow.upper_bound({key.domain, key.moment, UtcTime::max()});
            if (!facts.pinned && std::prev(next)->first != key) order.emplace_back(key.time, key);
        }
        std::sort(order.begin(), order.end());
        ASSERT_EQ(account_.used(), sum);
        ASSERT_EQ(account_.grid_count(), slow.size());
        const auto target = static_cast<std::uint64_t>(draw(3000));
        std::vector<GridName> expected;
        for (const auto& [time, key] : order) {
            if (sum <= target) break;
            sum -= slow[key].bytes;
            expected.push_back(key);
        }
        ASSERT_EQ(account_.down_to("", target, 1000), expected);
    }
}

}  // namespace
}  // namespace stormcellar::cache
