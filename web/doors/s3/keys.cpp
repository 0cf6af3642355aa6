#include "web/doors/s3/keys.h"

#include <algorithm>

#include <fmt/format.h>

#include "web/data/raw/raw_name.h"
#include "web/http/request.h"

namespace stormcellar::web {
namespace {

using std::chrono::days;
using std::chrono::sys_days;

constexpr std::size_t day_size = 11;     // "2022/03/17/"
constexpr std::size_t station_size = 5;  // "KTLX/"
constexpr sys_days earliest_day = std::chrono::year{1970} / 1 / 1;
constexpr sys_days latest_day = std::chrono::year{2199} / 12 / 31;

std::string day_text(sys_days day) {
    const std::chrono::year_month_day date{day};
    return fmt::format("{:04}/{:02}/{:02}/", static_cast<int>(date.year()),
                       static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()));
}

// Returns the first day whose text is not less than `text`, or none if there is none. The texts of
// days are in the order of the days.
std::optional<sys_days> day_not_less(std::string_view text) {
    sys_days low = earliest_day, high = latest_day + days{1};
    while (low < high) {
        const sys_days middle = low + (high - low) / 2;
        if (day_text(middle) < text) {
            low = middle + days{1};
        } else {
            high = middle;
        }
    }
    return low <= latest_day ? std::optional{low} : std::nullopt;
}

}  // namespace

std::string s3_key(const RawVolume& volume) {
    const auto day = std::chrono::floor<days>(volume.start);
    return fmt::format("{}{}/{}", day_text(day), volume.station, volume.name);
}

std::optional<S3Key> parse_s3_key(std::string_view key) {
    const auto segments = segments_of(key);
    if (segments.size() != 5 || key.size() < day_size || key.front() == '/' || key.back() == '/') {
        return std::nullopt;
    }
    const std::string_view day = key.substr(0, day_size);
    const auto found = day_not_less(day);
    if (!found || day_text(*found) != day) return std::nullopt;
    S3Key parsed{*found, std::string{segments[3]}, std::string{segments[4]}};
    const auto time = time_of_raw_name(parsed.station, parsed.name);
    if (time && std::chrono::floor<days>(*time) != parsed.day) return std::nullopt;
    return parsed;
}

Status S3Keys::find_stations() {
    if (stations_) return {};
    const auto known = files_->stations();
    if (!known) return pass_on(known);
    stations_.emplace();
    for (const RawStation& station : *known)
        stations_->push_back(station.icao);
    return {};
}

// Returns the objects of a day. `from` and `end` bound the part of the key after the day
// ("KTLX/KTLX20220317_0008" or shorter); an empty bound means that the whole day counts.
Result<std::vector<S3Object>> S3Keys::of_day(sys_days day, std::string_view from,
                                             std::string_view end, std::size_t most) const {
    std::vector<S3Object> objects;
    const std::string_view station_from = from.substr(0, station_size);
    for (const std::string& station : *stations_) {
        const std::string text = station + "/";
        if (text < station_from) continue;
        if (!end.empty() && text >= end) break;
        const std::string_view name_from =
            text == station_from ? from.substr(station_size) : std::string_view{};
        RawRange range;
        range.from = UtcTime{day};
        range.to = UtcTime{day + days{1}} - std::chrono::milliseconds{1};
        if (const auto time = time_of_raw_name(station, name_from))
            range.from = std::max(*range.from, *time);
        // Names of the same second may differ in their endings, so ask for a few more.
        range.most = most - objects.size() + (name_from.empty() ? 0 : 4);
        range.with_sizes = true;
        auto volumes = files_->list(station, range);
        if (!volumes) return pass_on(volumes);
        for (RawVolume& volume : *volumes) {
            if (volume.name < name_from || objects.size() == most) continue;
            if (!end.empty() && text + volume.name >= end) break;
            std::string key = s3_key(volume);
            objects.push_back({std::move(key), std::move(volume)});
        }
        if (objects.size() == most) break;
    }
    return objects;
}

Result<std::optional<sys_days>> S3Keys::next_day(sys_days day) const {
    std::optional<sys_days> next;
    for (const std::string& station : *stations_) {
        RawRange range;
        range.from = UtcTime{day};
        range.most = 1;
        const auto volumes = files_->list(station, range);
        if (!volumes) return pass_on(volumes);
        if (volumes->empty()) continue;
        const auto found = std::chrono::floor<days>(volumes->front().start);
        next = std::min(next.value_or(found), found);
        if (*next == day) break;
    }
    return next;
}

Result<std::vector<S3Object>> S3Keys::between(std::string_view from, std::string_view end,
                                              std::size_t most) {
    if (Status found = find_stations(); !found) return pass_on(found);
    // Returns the part of a bound after the day if the bound is in this day, else an empty text.
    const auto within = [](std::string_view bound, sys_days day) {
        const bool is_within = bound.substr(0, day_size) == day_text(day);
        return is_within ? bound.substr(day_size) : std::string_view{};
    };
    std::optional<sys_days> day = day_not_less(from.substr(0, day_size));
    while (day && (end.empty() || day_text(*day) < end)) {
        auto objects = of_day(*day, within(from, *day), within(end, *day), most);
        if (!objects) return pass_on(objects);
        if (!objects->empty()) return objects;
        const sys_days following = *day + days{1};
        if (!end.empty() && day_text(following) >= end) break;
        const auto next = next_day(following);
        if (!next) return pass_on(next);
        day = *next;
    }
    return std::vector<S3Object>{};
}

}  // namespace stormcellar::web
