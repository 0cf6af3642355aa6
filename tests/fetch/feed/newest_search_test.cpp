// The numbers of volumes go around a ring from 1 to 999. Wherever the newest volume is in the ring,
// the search must find it with few questions.
#include "fetch/feed/newest_search.h"

#include <array>
#include <random>

#include <gtest/gtest.h>

#include "tests/fetch/feed/made_keys.h"

namespace stormcellar::feed {
namespace {

using std::chrono::minutes;

const UtcTime noon = *parse_utc("2026-11-28T12:00:00Z", {});

struct Found {
    std::optional<NewestSearch::Start> start;
    int questions = 0;
};

Found search(const std::set<std::string>& keys) {
    NewestSearch search("KTLX");
    Found found;
    while (!search.is_done() && found.questions < 1000) {
        ++found.questions;
        search.take(listed(keys, search.question()), noon);
    }
    found.start = search.start();
    return found;
}

// Returns the keys of a station that made `kept` volumes, one every five minutes; the last volume
// has number `newest`.
std::set<std::string> ring(int newest, int kept) {
    std::set<std::string> keys;
    for (int back = 0; back < kept; ++back) {
        const int number = (newest - 1 - back % 999 + 999) % 999 + 1;
        add_volume(keys, number, noon - minutes{5 * back + 1}, 2);
    }
    return keys;
}

int before(int number) {
    return number == 1 ? 999 : number - 1;
}

TEST(NewestSearch, FindsTheNewestOfAnyRing) {
    std::mt19937 chance(1);
    for (int round = 0; round < 60; ++round) {
        const int newest = round < 4
                               ? std::array{1, 2, 998, 999}.at(static_cast<std::size_t>(round))
                               : static_cast<int>(chance() % 999) + 1;
        // A few volumes, a part of a ring, a whole ring, and more than one round.
        for (const int kept : {2, 3, 17, 288, 998, 999, 1005, 1500}) {
            const Found found = search(ring(newest, kept));
            ASSERT_TRUE(found.start) << newest << ' ' << kept;
            EXPECT_EQ(found.start->number, before(newest)) << newest << ' ' << kept;
            EXPECT_LE(found.questions, 13);
            // Volumes before `from` count as an earlier round.
            const UtcTime wanted = noon - minutes{6};
            EXPECT_LE(found.start->from, wanted);
            EXPECT_GT(found.start->from, wanted - minutes{5 * 999});
        }
    }
}

TEST(NewestSearch, OneVolumeIsTheNewest) {
    const Found found = search(ring(7, 1));
    ASSERT_TRUE(found.start);
    EXPECT_EQ(found.start->number, 7);
}

TEST(NewestSearch, AStationWithoutVolumesHasNone) {
    EXPECT_FALSE(search({}).start);
    EXPECT_FALSE(search({"KTLX/494/readme.txt", "KTLX/index.html", "KTLX/../x"}).start);
}

TEST(NewestSearch, ANumberThatBeganAnewIsFound) {
    std::set<std::string> keys = ring(500, 499);  // volumes 2 to 500
    std::set<std::string> later;
    for (int number = 1; number <= 20; ++number) {
        const std::string prefix = fmt::format("KTLX/{}/", number);
        std::erase_if(keys, [&](const std::string& key) { return key.starts_with(prefix); });
        add_volume(later, number, noon + minutes{5 * number}, 2);
    }
    keys.merge(later);
    const Found found = search(keys);
    ASSERT_TRUE(found.start);
    EXPECT_EQ(found.start->number, 19);
}

TEST(NewestSearch, JunkBetweenTheChunksChangesNothing) {
    std::set<std::string> keys = ring(321, 700);
    for (int number = 1; number <= 999; number += 3)
        keys.insert(fmt::format("KTLX/{}/20990101-000000-001-S", number));
    keys.insert("KTLX/1000/20261128-115959-001-S");
    keys.insert("KTLX/0321/20261128-115959-001-S");
    const Found found = search(keys);
    ASSERT_TRUE(found.start);
    EXPECT_EQ(found.start->number, 320);
}

}  // namespace
}  // namespace stormcellar::feed
