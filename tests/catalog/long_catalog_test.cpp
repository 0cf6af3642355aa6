// Tests that the time of a question about a few volumes does not depend on the number of all
// volumes.
#include <algorithm>
#include <chrono>

#include <gtest/gtest.h>

#include "tests/catalog/catalog_fixture.h"

namespace stormcellar::catalog {
namespace {

constexpr int volume_count = 20'000;
constexpr std::chrono::minutes apart{5};
const UtcTime first_start = at("2024-06-01T00:00:00Z");

class LongCatalogTest : public CatalogTest {
  protected:
    LongCatalogTest() {
        std::vector<FileFacts> files;
        for (int i = 0; i < volume_count; ++i) {
            VolumeFacts facts = volume("2024-06-01T00:00:00Z", i % 1000);
            facts.start_time = first_start + i * apart;
            files.push_back(file("/d/" + std::to_string(i), {facts}));
        }
        EXPECT_TRUE(catalog_.register_files("KTLX", files));
    }
    // Returns the least time of several tries, in seconds.
    template <class Question>
    static double time_of(Question question) {
        double least = 1e9;
        for (int i = 0; i < 5; ++i) {
            const auto began = std::chrono::steady_clock::now();
            EXPECT_TRUE(question());
            const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began;
            least = std::min(least, took.count());
        }
        return least;
    }
};

// 2026-11-27: for the newest volume, or for the list of a day, SQLite read the whole table of
// parts. With a million rows, the data server took more than a second to start.
TEST_F(LongCatalogTest, AFewVolumesTakeNoTimeForTheOthers) {
    const auto reader = CatalogReader::open(directory_ / "catalog");
    ASSERT_TRUE(reader);
    const double all_s = time_of([&] {
        const auto listed = reader->list("KTLX", {});
        return listed && listed->size() == volume_count;
    });
    const UtcTime noon = first_start + std::chrono::days{30};
    const auto is_quick = [&](auto question) { return time_of(question) < all_s / 40; };
    EXPECT_TRUE(is_quick([&] { return reader->latest("KTLX")->has_value(); }));
    EXPECT_TRUE(is_quick([&] { return reader->oldest("KTLX")->has_value(); }));
    EXPECT_TRUE(is_quick([&] {
        return reader->list("KTLX", {noon, noon + std::chrono::hours{2}})->size() == 25;
    }));
    EXPECT_TRUE(is_quick([&] { return reader->list("KTLX", {{}, {}, false, 25})->size() == 25; }));
    EXPECT_TRUE(is_quick([&] {
        return reader->list_stretch("KTLX", {.from = noon, .to = {}, .most = 25})->size() == 25;
    }));
}

TEST_F(CatalogTest, TheNewestAreTheEndOfTheList) {
    std::vector<FileFacts> files;
    for (const char* start : {"2024-06-01T00:00:00Z", "2024-06-01T00:05:00Z"}) {
        for (const int number : {7, 3}) {
            for (const char* name : {"b", "a"}) {
                const std::string path = "/d/" + std::string(start) + std::to_string(number) + name;
                files.push_back(file(path, {volume(start, number)}));
                files.back().content_hash += files.size() / 2;
            }
        }
    }
    ASSERT_TRUE(catalog_.register_files("KTLX", files));
    const auto all = catalog_.list("KTLX", {});
    ASSERT_TRUE(all && all->size() == files.size());
    for (std::size_t most = 0; most <= files.size() + 1; ++most) {
        const auto newest = catalog_.list("KTLX", {{}, {}, false, most});
        ASSERT_TRUE(newest);
        ASSERT_EQ(newest->size(), std::min(most, files.size()));
        for (std::size_t i = 0; i < newest->size(); ++i)
            EXPECT_EQ((*newest)[i].path, (*all)[all->size() - newest->size() + i].path) << most;
    }
}

}  // namespace
}  // namespace stormcellar::catalog
