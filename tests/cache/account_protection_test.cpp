// Tests which grids are protected, up to which size, and the order of eviction, as promised in
// stormcellar/cache/budget.h.
#include <algorithm>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cache/account.h"
#include "tests/cache/made_grids.h"

namespace stormcellar::cache {
namespace {

using std::chrono::hours;
using std::chrono::minutes;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::noon;
using ::testing::Optional;

// Times are in minutes after noon.
constexpr auto name = testing::grid_named;

class AccountProtectionTest : public ::testing::Test {
  protected:
    AccountProtectionTest() { account_.set_now(noon + hours{24}); }
    void put(const std::string& domain, int minute, std::uint64_t bytes = 10,
             UtcTime written = noon + hours{24}) {
        account_.put(name(domain, minute), {bytes, written, false});
    }
    [[nodiscard]] auto room(const GridName& grid, std::uint64_t bytes,
                            Reach reach = Reach::unprotected) const {
        return account_.room_for(grid, bytes, budgets_, reach);
    }
    [[nodiscard]] auto all_that_may_go(std::optional<std::uint64_t> space = std::nullopt) const {
        return account_.down_to("", 0, 1000, {budgets_.protected_for, space});
    }
    Account account_;
    Budgets budgets_;
};

TEST(IsKnownGroup, StationsOfTheTableAndAllThatHasNotAnIcaosForm) {
    for (const char* known : {"KTLX", "TOKC", "northeast", "A", "Kxyz", "XAAA2", "1AAA"})
        EXPECT_TRUE(is_known_group(known)) << known;
    for (const char* invented : {"XAAA", "KZZZ", "X123"})
        EXPECT_FALSE(is_known_group(invented)) << invented;
}

TEST_F(AccountProtectionTest, TheNewestIsProtectedWhileItsFileIsYoung) {
    budgets_.protected_for = hours{12};
    put("KTLX", -60 * 24 * 3650, 10, noon + hours{12} + minutes{1});  // replayed old data
    put("KINX", 0, 10, noon + hours{12});
    put("northeast", 1, 10, noon + hours{12});
    put("northeast.KBOX", 2, 10, noon + hours{13});
    EXPECT_THAT(all_that_may_go(), ElementsAre(name("KINX", 0), name("northeast", 1)));
    account_.set_now(noon + hours{24} + minutes{1});
    EXPECT_THAT(all_that_may_go(),
                ElementsAre(name("KTLX", -60 * 24 * 3650), name("KINX", 0), name("northeast", 1)));
    budgets_.protected_for = hours{0};
    EXPECT_THAT(all_that_may_go(), IsEmpty()) << "0 means that there is no limit";
}

TEST_F(AccountProtectionTest, AgeSparesTheNewestOfAMomentNoLongerThanThat) {
    budgets_.protected_for = hours{12};
    budgets_.total.age = hours{1};
    put("KTLX", 0);
    account_.put({"KTLX", level2::Moment::vel, noon - hours{2}}, {10, noon + hours{13}, false});
    EXPECT_THAT(account_.expired("KTLX", budgets_, 100), IsEmpty());
    account_.set_now(noon + hours{25});
    EXPECT_THAT(account_.expired("KTLX", budgets_, 100).size(), 1U);
}

TEST_F(AccountProtectionTest, NothingIsProtectedOfWhomNobodyKnows) {
    put("XAAA", 0);
    put("XBBB", 2);
    put("KTLX", 1);
    EXPECT_THAT(all_that_may_go(), ElementsAre(name("XAAA", 0), name("XBBB", 2)));
    EXPECT_TRUE(account_.is_to_stay(name("KTLX", 5)));
    EXPECT_TRUE(account_.is_to_stay(name("KINX", 5)));
    EXPECT_FALSE(account_.is_to_stay(name("XAAA", 5)));
    EXPECT_FALSE(account_.is_to_stay(name("XCCC", 5)));
}

TEST_F(AccountProtectionTest, WhatIsProtectedHoldsAtMostHalfAndTheLargestLapsesFirst) {
    put("KTLX", 0, 40);
    put("KINX", 1, 10);
    put("KBGM", 2, 10);
    put("KOKX", 3, 10);
    EXPECT_THAT(all_that_may_go(140), IsEmpty());
    EXPECT_THAT(all_that_may_go(139), ElementsAre(name("KTLX", 0)));
    EXPECT_THAT(all_that_may_go(60), ElementsAre(name("KTLX", 0)));
    EXPECT_THAT(all_that_may_go(59), ElementsAre(name("KTLX", 0), name("KINX", 1)))
        << "the oldest of equally large grids loses its protection first";
    EXPECT_EQ(all_that_may_go(0).size(), 4U);
}

TEST_F(AccountProtectionTest, AGroupsOwnBudgetIsProtectedByHalfToo) {
    put("northeast", 9, 30);
    put("northeast.KBOX", 0, 10);
    put("northeast.KOKX", 1, 10);
    put("KTLX", 2, 10);
    budgets_.domains["northeast"].bytes = 50;
    EXPECT_THAT(*room(name("northeast", 10), 30), ElementsAre(name("northeast", 9)))
        << "the partials hold 20 of the 25 bytes that may be protected";
    EXPECT_EQ(account_.down_to("northeast", 0, 10, {hours{168}, 50}).size(), 1U);
    EXPECT_EQ(account_.down_to("northeast", 0, 10, {hours{168}, 30}).size(), 2U);
    EXPECT_EQ(account_.down_to("northeast", 0, 10, {hours{168}, 10}).size(), 3U);
}

TEST_F(AccountProtectionTest, PinnedGridsAreNotCountedAmongTheProtected) {
    account_.put(name("KTLX", 0), {90, noon, true});
    put("KINX", 1, 10);
    EXPECT_THAT(all_that_may_go(20), IsEmpty());
}

// Evicting protected grids is the last resort if a grid is larger than half of the budget, or
// pinned grids leave too little room.
TEST_F(AccountProtectionTest, TheNewestOfAKnownStationTakesProtectedOnesAsALastResort) {
    put("KTLX", 0, 10);
    put("KINX", 1, 10);
    account_.put(name("KBGM", 2), {30, noon, true});
    budgets_.total.bytes = 50;
    EXPECT_FALSE(room(name("KOKX", 3), 10));
    EXPECT_THAT(room(name("KOKX", 3), 10, Reach::all), Optional(ElementsAre(name("KTLX", 0))));
    EXPECT_THAT(room(name("KOKX", 3), 20, Reach::all),
                Optional(ElementsAre(name("KTLX", 0), name("KINX", 1))));
    EXPECT_FALSE(room(name("KOKX", 3), 21, Reach::all)) << "the pinned grid must stay";
}

TEST_F(AccountProtectionTest, OthersGoBeforeAnyHistoryThatIsKnown) {
    for (int minute = 0; minute < 3; ++minute) {
        put("KTLX", minute);
        put("XAAA", 100 + minute);
    }
    budgets_.total.bytes = 60;
    EXPECT_THAT(*room(name("KTLX", 3), 10), ElementsAre(name("XAAA", 100)));
    EXPECT_THAT(*room(name("KTLX", 3), 40), ElementsAre(name("XAAA", 100), name("XAAA", 101),
                                                        name("XAAA", 102), name("KTLX", 0)));
    EXPECT_THAT(account_.oldest(name("KTLX", 3), 20, budgets_),
                ElementsAre(name("XAAA", 100), name("XAAA", 101)));
    EXPECT_THAT(account_.down_to("", 30, 100),
                ElementsAre(name("XAAA", 100), name("XAAA", 101), name("XAAA", 102)));
    EXPECT_THAT(account_.down_to("", 0, 100, {}, Reach::others).size(), 3U);
    // Grids of unknown stations ("others") give room even to an older grid of a known station.
    EXPECT_THAT(*room(name("KTLX", 1), 10), ElementsAre(name("XAAA", 100)));
    EXPECT_TRUE(room(name("KTLX", -1), 10))
        << "grids of others are evicted before any grid of KTLX";
}

TEST_F(AccountProtectionTest, OthersMakeRoomOnlyForOneAnother) {
    for (int minute = 0; minute < 9; ++minute)
        put("KTLX", minute);
    budgets_.total.bytes = 100;
    EXPECT_TRUE(account_.fits("XAAA", 10, budgets_));
    put("XAAA", 100);
    EXPECT_THAT(*room(name("XBBB", 101), 10), ElementsAre(name("XAAA", 100)));
    EXPECT_FALSE(room(name("XBBB", 99), 10)) << "the new grid would be the oldest grid of others";
    EXPECT_FALSE(room(name("XBBB", 101), 11)) << "the grid exceeds the share of others";
    put("KTLX", 10);
    EXPECT_FALSE(room(name("XAAA", 101), 11, Reach::all));
    account_.erase(name("XAAA", 100));
    EXPECT_FALSE(room(name("XBBB", 101), 10)) << "known grids fill the budget";
    EXPECT_THAT(account_.oldest(name("XBBB", 101), 10, budgets_), IsEmpty());
}

TEST_F(AccountProtectionTest, OthersHoldATenthOfTheBudgetTogether) {
    budgets_.total.bytes = 1000;
    for (int minute = 0; minute < 10; ++minute)
        put("XAA" + std::string(1, static_cast<char>('A' + minute)), minute);
    EXPECT_EQ(account_.used_by_others(), 100U);
    EXPECT_FALSE(account_.fits("XBBB", 1, budgets_));
    EXPECT_TRUE(account_.fits("KTLX", 900, budgets_));
    EXPECT_THAT(*room(name("XBBB", 20), 11), ElementsAre(name("XAAA", 0), name("XAAB", 1)));
    EXPECT_THAT(account_.others_down_to(80, 100), ElementsAre(name("XAAA", 0), name("XAAB", 1)));
    // Files that are being written count toward the tenth of the budget that others may hold.
    account_.reserve("XCCC", 20);
    EXPECT_EQ(account_.used_by_others(), 120U);
    account_.release("XCCC", 20);
    // With a budget in percent of the file system, others may hold a tenth of this budget.
    budgets_.total.bytes.reset();
    EXPECT_EQ(account_.others_limit(budgets_), std::nullopt);
    budgets_.total.file_system_percent = 50;
    EXPECT_EQ(account_.others_limit(budgets_), std::nullopt)
        << "the size of the file system is unknown";
    account_.set_capacity(2000);
    EXPECT_FALSE(account_.fits("XBBB", 1, budgets_));
    EXPECT_EQ(account_.others_limit(budgets_), 100U);
    budgets_.total.bytes = 900;
    EXPECT_EQ(account_.others_limit(budgets_), 90U) << "the smaller limit counts";
}

TEST_F(AccountProtectionTest, OthersOutliveNobodysProtection) {
    budgets_.protected_for = hours{12};
    put("XAAA", 0, 10, noon + hours{12});
    put("XBBB", -60 * 24, 10, noon + hours{12} + minutes{1});
    put("XCCC", 1, 10, noon + hours{24 * 365});  // by a wrong clock
    account_.put(name("XDDD", 2), {10, noon, true});
    put("KTLX", 3, 10, noon);
    EXPECT_THAT(account_.outlived(budgets_, 100), ElementsAre(name("XAAA", 0), name("XCCC", 1)));
    EXPECT_THAT(account_.outlived(budgets_, 1), ElementsAre(name("XAAA", 0)));
    budgets_.protected_for = hours{0};
    EXPECT_THAT(account_.outlived(budgets_, 100), IsEmpty());
}

TEST_F(AccountProtectionTest, WhoIsKnownMayChange) {
    std::set<std::string, std::less<>> known = {"KTLX"};
    Account account([&](std::string_view group) { return known.contains(group); });
    account.set_now(noon + hours{24});
    for (int minute = 0; minute < 2; ++minute) {
        account.put(name("XAAA", 10 + minute), {10, noon, false});
        account.put(name("KTLX", minute), {10, noon, false});
    }
    account.reserve("XAAA", 5);
    EXPECT_EQ(account.used_by_others(), 25U);
    known = {"XAAA"};
    EXPECT_FALSE(account.is_known("XAAA")) << "ask_who_is_known() was not called";
    account.ask_who_is_known("XAAA");
    EXPECT_TRUE(account.is_known("XAAA"));
    EXPECT_TRUE(account.is_known("KTLX"));
    account.ask_who_is_known();
    EXPECT_EQ(account.used_by_others(), 20U);
    account.release("XAAA", 5);
    EXPECT_THAT(account.down_to("", 0, 100),
                ElementsAre(name("KTLX", 0), name("KTLX", 1), name("XAAA", 10)));
}

TEST_F(AccountProtectionTest, AGroupThatHoldsNothingIsForgotten) {
    put("XAAA", 0);
    account_.reserve("XBBB", 5);
    EXPECT_EQ(account_.groups().size(), 2U);
    account_.erase(name("XAAA", 0));
    account_.release("XBBB", 5);
    EXPECT_THAT(account_.groups(), IsEmpty());
}

struct SlowGrid {
    GridName name;
    GridFacts facts;
    bool newest = false;
};

// Chooses grids as stormcellar/cache/budget.h describes, in a slow and simple way.
std::vector<GridName> slow_choice(const std::map<GridName, GridFacts>& grids, std::uint64_t target,
                                  std::uint64_t space) {
    std::vector<SlowGrid> going, protected_ones;
    std::uint64_t held = 0, half = space / 2;
    for (auto grid = grids.begin(); grid != grids.end(); ++grid) {
        const auto next = std::next(grid);
        const bool newest = next == grids.end() || next->first.domain != grid->first.domain;
        held += grid->second.bytes;
        if (grid->second.pinned) continue;
        const bool is_protected = newest && is_known_group(group_of(grid->first.domain));
        (is_protected ? protected_ones : going).push_back({grid->first, grid->second, newest});
    }
    const auto size = [](const SlowGrid& grid) {
        return std::tuple(grid.facts.bytes, noon - grid.name.time);
    };
    std::stable_sort(protected_ones.begin(), protected_ones.end(),
                     [&](const auto& a, const auto& b) { return size(a) < size(b); });
    bool lapsed = false;
    for (const SlowGrid& grid : protected_ones) {
        lapsed = lapsed || grid.facts.bytes > half;
        if (lapsed) going.push_back(grid);
        if (!lapsed) half -= grid.facts.bytes;
    }
    const auto rank = [](const SlowGrid& grid) {
        return std::tuple(is_known_group(group_of(grid.name.domain)), grid.name.time, grid.name);
    };
    std::sort(going.begin(), going.end(),
              [&](const auto& a, const auto& b) { return rank(a) < rank(b); });
    std::vector<GridName> chosen;
    for (const SlowGrid& grid : going) {
        if (held <= target) break;
        held -= grid.facts.bytes;
        chosen.push_back(grid.name);
    }
    return chosen;
}

TEST_F(AccountProtectionTest, AgreesWithTheSlowWayOverRandomChanges) {
    std::mt19937 random(11);
    const auto draw = [&](int end) {
        return static_cast<int>(random() % static_cast<unsigned>(end));
    };
    const std::vector<std::string> domains = {"KTLX", "KINX",  "XAAA",
                                              "XBBB", "north", "north.KBOX"};
    std::map<GridName, GridFacts> slow;
    int lapses = 0;
    for (int step = 0; step < 3000; ++step) {
        const auto which = static_cast<std::size_t>(draw(static_cast<int>(domains.size())));
        // Each grid has a different time, so that no two grids are equally old.
        const GridName grid = name(
            domains[which], draw(20) * static_cast<int>(domains.size()) + static_cast<int>(which));
        if (draw(3) == 0) {
            account_.erase(grid);
            slow.erase(grid);
        } else {
            const GridFacts facts{static_cast<std::uint64_t>(1 + draw(100)), noon, draw(8) == 0};
            account_.put(grid, facts);
            slow[grid] = facts;
        }
        const auto target = static_cast<std::uint64_t>(draw(4000));
        const auto space = static_cast<std::uint64_t>(draw(800));
        const auto expected = slow_choice(slow, target, space);
        ASSERT_EQ(account_.down_to("", target, 1000, {hours{168}, space}), expected);
        if (expected != slow_choice(slow, target, 1'000'000)) ++lapses;
    }
    EXPECT_GT(lapses, 300) << "no protection lapsed";
}

}  // namespace
}  // namespace stormcellar::cache
