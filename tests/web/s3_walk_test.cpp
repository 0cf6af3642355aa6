// Compares lists of a bucket with a sorted list of all keys, and counts the queries to the catalog.
#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "web/doors/s3/listing.h"

namespace stormcellar::web {
namespace {

// Volumes without files. Records which lists are requested.
class CountedVolumes final : public RawFiles {
  public:
    CountedVolumes(std::vector<std::string> stations, const std::vector<UtcTime>& starts)
        : stations_(std::move(stations)) {
        for (const std::string& station : stations_) {
            for (const UtcTime start : starts) {
                RawVolume volume;
                volume.station = station;
                volume.name = station + format_compact(start) + "_V06";
                volume.start = start;
                volume.is_complete = true;
                volumes_.push_back(std::move(volume));
            }
        }
    }
    Result<std::vector<RawStation>> stations() override {
        std::vector<RawStation> stations;
        for (const std::string& icao : stations_)
            stations.push_back({.icao = icao, .name = {}, .state = {}});
        return stations;
    }
    Result<std::vector<RawVolume>> list(std::string_view station, const RawRange& range) override {
        asked.emplace_back(station);
        std::vector<RawVolume> listed;
        for (const RawVolume& volume : volumes_) {
            const bool fits = volume.station == station &&
                              (!range.from || volume.start >= *range.from) &&
                              (!range.to || volume.start <= *range.to);
            if (fits && listed.size() < range.most) listed.push_back(volume);
        }
        return listed;
    }
    OpenedOrMissing open(std::string_view, std::string_view) override {
        return tl::unexpected(RawFailure{});
    }
    std::optional<OpenedVolume> open_kept(std::string_view, std::string_view) override {
        return std::nullopt;
    }
    [[nodiscard]] std::vector<std::string> keys() const {
        std::vector<std::string> keys;
        for (const RawVolume& volume : volumes_)
            keys.push_back(s3_key(volume));
        std::ranges::sort(keys);
        return keys;
    }

    std::vector<std::string> asked;  // the station of each list

  private:
    std::vector<std::string> stations_;
    std::vector<RawVolume> volumes_;
};

UtcTime start_at(const char* text) {
    return *parse_utc(text, UtcTime{});
}

std::vector<UtcTime> some_starts() {
    return {start_at("2023-12-31T23:55:00Z"), start_at("2024-01-01T00:00:00Z"),
            start_at("2024-06-01T00:00:10Z"), start_at("2024-06-01T09:59:59Z"),
            start_at("2024-06-01T10:00:00Z"), start_at("2024-06-02T23:59:59Z"),
            start_at("2024-11-30T12:00:00Z")};
}

// Returns the keys and common prefixes that a list must have, from a look at every key.
std::vector<std::string> expected_list(const std::vector<std::string>& keys,
                                       const S3ListOptions& options) {
    std::vector<std::string> entries;
    for (const std::string& key : keys) {
        if (!key.starts_with(options.prefix)) continue;
        const std::size_t at = options.delimiter.empty()
                                   ? std::string::npos
                                   : key.find(options.delimiter, options.prefix.size());
        const std::string entry =
            at == std::string::npos ? key : key.substr(0, at + options.delimiter.size());
        if (entries.empty() || entries.back() != entry) entries.push_back(entry);
    }
    return entries;
}

// Returns the entries of all pages of a list.
std::vector<std::string> all_pages(S3Keys& keys, S3ListOptions options) {
    std::vector<std::string> entries;
    for (int page = 0; page < 1000; ++page) {
        const auto listing = list_s3_objects(keys, options);
        if (!listing) return {"an error"};
        std::vector<std::string> here = listing->common_prefixes;
        for (const S3Object& object : listing->objects)
            here.push_back(object.key);
        if (here.size() > options.most) return {"too many on a page"};
        std::ranges::sort(here);
        entries.insert(entries.end(), here.begin(), here.end());
        if (listing->next.empty()) return entries;
        options.after = listing->next;
    }
    return {"no end"};
}

TEST(S3Walk, EveryPrefixDelimiterAndPageGivesWhatASortGives) {
    const auto files = std::make_shared<CountedVolumes>(
        std::vector<std::string>{"KABR", "KABX", "KTLX"}, some_starts());
    S3Keys keys(files);
    S3ListOptions options;
    for (const char* prefix : {"",
                               "2",
                               "2023",
                               "2024/",
                               "2024/0",
                               "2024/06",
                               "2024/06/",
                               "2024/06/0",
                               "2024/06/01",
                               "2024/06/01/",
                               "2024/06/01/KAB",
                               "2024/06/01/KABR",
                               "2024/06/01/KABR/",
                               "2024/06/01/KABR/KABR20240601_0",
                               "2024/06/01/KABR/KABR20240601_1000",
                               "2024/06/01/KABR/KABR20240601_100000_V06",
                               "2024/06/01/KABS/",
                               "2024/06/01/KTLX/z",
                               "2024/06/03/",
                               "2025/",
                               "zzz",
                               "\xFF\xFF"}) {
        for (const char* delimiter : {"", "/", "_", "K"}) {
            for (const std::size_t most : {1, 2, 3, 1000}) {
                options.prefix = prefix;
                options.delimiter = delimiter;
                options.most = most;
                EXPECT_EQ(all_pages(keys, options), expected_list(files->keys(), options))
                    << prefix << ", " << delimiter << ", " << most;
            }
        }
    }
}

// 2026-11-27: the list of one station's day also read the days of other stations.
TEST(S3Walk, AListOfAStationsDayAsksForNothingElse) {
    std::vector<UtcTime> starts;
    for (int i = 0; i < 3 * 288; ++i)
        starts.push_back(start_at("2024-06-01T00:00:00Z") + i * std::chrono::minutes{5});
    const auto files = std::make_shared<CountedVolumes>(
        std::vector<std::string>{"KABR", "KABX", "KAKQ", "KTLX"}, starts);
    S3Keys keys(files);
    S3ListOptions options;
    for (const char* delimiter : {"", "/"}) {
        files->asked.clear();
        options.prefix = "2024/06/02/KABX/";
        options.delimiter = delimiter;
        const auto listing = list_s3_objects(keys, options);
        ASSERT_TRUE(listing);
        EXPECT_EQ(listing->objects.size(), 288U);
        EXPECT_LE(files->asked.size(), 3U);
        EXPECT_EQ(std::set<std::string>(files->asked.begin(), files->asked.end()),
                  std::set<std::string>{"KABX"});
    }
}

}  // namespace
}  // namespace stormcellar::web
