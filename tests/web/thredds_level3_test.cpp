// Tests files of Level III: which file is the nearest, and how many steps the search takes.
#include <algorithm>
#include <chrono>
#include <fstream>
#include <map>
#include <random>

#include <gtest/gtest.h>

#include "tests/testing/temporary_directory.h"
#include "tests/web/asked.h"
#include "web/doors/thredds/collection.h"
#include "web/doors/thredds/nearest_time.h"

namespace stormcellar::web {
namespace {

using namespace std::chrono_literals;

class ThreddsLevel3 : public ::testing::Test {
  protected:
    // Makes files every five minutes, except for one hour of each day.
    void make_files(int count) {
        for (UtcTime time = first_; static_cast<int>(starts_.size()) < count; time += 5min) {
            if (time.time_since_epoch() % 24h < 1h) continue;
            const std::string name =
                "Level3_FTG_N0Q_" + format_compact(time).substr(0, 13) + ".nids";
            std::ofstream file(directory_ / name);
            starts_.push_back(time);
        }
        ConfiguredCollection configured;
        configured.path = "nexrad/level3/IDD";
        configured.variables = {"N0Q"};
        configured.files = directory_.path();
        collection_ = make_level3_collection(configured, {});
    }
    // Returns the nearest start by comparing all starts.
    [[nodiscard]] std::optional<UtcTime> nearest_of_all(UtcTime time,
                                                        std::chrono::milliseconds within) const {
        std::optional<UtcTime> best;
        for (const UtcTime start : starts_) {
            const auto distance = std::chrono::abs(start - time);
            if (distance <= within && (!best || distance < std::chrono::abs(*best - time)))
                best = start;
        }
        return best;
    }

    testing::TemporaryDirectory directory_;
    const UtcTime first_ = *parse_compact("20150615_120000");
    std::vector<UtcTime> starts_;
    std::shared_ptr<ThreddsCollection> collection_;
};

// A map that counts the steps of its iterators, and cannot be copied.
struct StepCounter {
    using Map = std::map<UtcTime, int>;
    static inline int steps = 0;
    struct Iterator : Map::const_iterator {
        Iterator() = default;
        explicit Iterator(Map::const_iterator at) : Map::const_iterator(at) {}
        Iterator& operator++() {
            ++steps;
            Map::const_iterator::operator++();
            return *this;
        }
        Iterator& operator--() {
            ++steps;
            Map::const_iterator::operator--();
            return *this;
        }
    };
    struct Times {
        Times() = default;
        Times(const Times&) = delete;
        [[nodiscard]] Iterator begin() const { return Iterator(map.begin()); }
        [[nodiscard]] Iterator end() const { return Iterator(map.end()); }
        [[nodiscard]] Iterator lower_bound(UtcTime time) const {
            return Iterator(map.lower_bound(time));
        }
        Map map;
    };
};

TEST_F(ThreddsLevel3, TheNearestFileIsThatOfASearchOfAll) {
    make_files(600);
    std::mt19937 random(44);
    for (int i = 0; i < 2000; ++i) {
        const UtcTime time = first_ - 3h + std::chrono::seconds{random() % 260'000};
        const auto within = std::chrono::seconds{random() % 4000};
        const auto found = collection_->nearest({"FTG", "N0Q"}, time, within);
        ASSERT_TRUE(found);
        const auto expected = nearest_of_all(time, within);
        ASSERT_EQ(found->has_value(), expected.has_value()) << format_utc(time);
        if (!expected) continue;
        EXPECT_EQ((*found)->start, *expected) << format_utc(time);
    }
}

// 2026-11-28: each search copied the times of all files and walked to their end. One query makes
// 10,000 searches, and four queries stopped the server for minutes.
TEST(NearestTime, DoesNotWalkThroughAllTimes) {
    StepCounter::Times times;
    for (int i = 0; i < 5000; ++i)
        times.map.emplace(UtcTime{i * 5min}, i);
    for (int i = -1; i <= 5000; ++i) {
        StepCounter::steps = 0;
        EXPECT_EQ(nearest_time(times, UtcTime{i * 5min + 1min})->second, std::clamp(i, 0, 4999));
        EXPECT_LE(StepCounter::steps, 1) << i;
    }
}

// 2026-11-28: a file that existed but could not be read was reported as deleted.
TEST_F(ThreddsLevel3, AFileThatCannotBeReadIsNotDeleted) {
    make_files(3);
    const auto status_of_file = [&](UtcTime start) {
        const std::string name = "Level3_FTG_N0Q_" + format_compact(start).substr(0, 13) + ".nids";
        const std::vector<std::string_view> path{"N0Q", "FTG", "20150615", name};
        return collection_->file(request_for("/"), path).status;
    };
    ASSERT_EQ(status_of_file(starts_[0]), 200U);
    const auto path_of = [&](UtcTime start) {
        return directory_ / ("Level3_FTG_N0Q_" + format_compact(start).substr(0, 13) + ".nids");
    };
    std::filesystem::remove(path_of(starts_[1]));
    EXPECT_EQ(status_of_file(starts_[1]), 410U);
    // Root may read every file, so a directory takes the place of an unreadable file.
    std::filesystem::remove(path_of(starts_[2]));
    std::filesystem::create_directory(path_of(starts_[2]));
    EXPECT_EQ(status_of_file(starts_[2]), 503U);
}

TEST_F(ThreddsLevel3, AListHasTheFilesOfItsRange) {
    make_files(100);
    RawRange range;
    range.from = first_ + 1h;
    range.to = first_ + 2h;
    range.most = 1000;
    EXPECT_EQ(collection_->list({"FTG", "N0Q"}, range)->size(), 13u);
    range.most = 5;
    EXPECT_EQ(collection_->list({"FTG", "N0Q"}, range)->size(), 5u);
    EXPECT_TRUE(collection_->list({"FTG", "N0C"}, range)->empty());
}

}  // namespace
}  // namespace stormcellar::web
