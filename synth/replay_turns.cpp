#include "synth/replay_turns.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <set>
#include <string>
#include <utility>

namespace stormcellar::synth {
namespace {

namespace fs = std::filesystem;

constexpr double longest_replay_s = 1e8;  // three years, so that no clock overflows
constexpr int most_numbers = 1000;        // of volumes: 0 to 999

std::vector<ReplayTurn> one_by_one(std::size_t files, double interval_s) {
    std::vector<ReplayTurn> turns(files);
    for (std::size_t i = 0; i < files; ++i)
        turns[i] = {interval_s * static_cast<double>(i), interval_s};
    return turns;
}

}  // namespace

std::vector<ReplayTurn> turns_of(const std::vector<ReplayItem>& items,
                                 const ReplayOptions& options) {
    if (options.interval_s) return one_by_one(items.size(), *options.interval_s);
    struct Newest {
        std::size_t item = 0;
        double span_s = 0;  // of the previous volume
    };
    std::map<std::string, Newest> newest;  // by station
    std::vector<ReplayTurn> turns(items.size());
    double start_s = 0;
    for (std::size_t i = 0; i < items.size(); ++i) {
        const ReplayItem& item = items[i];
        if (!item.time) {  // sorted after all items that have a time
            turns[i].start_s = start_s;
            continue;
        }
        const std::chrono::duration<double> since = *item.time - *items.front().time;
        start_s = std::min(since.count() / options.speed, longest_replay_s);
        turns[i].start_s = start_s;
        const auto [place, first] =
            newest.try_emplace(item.station, Newest{i, usual_volume_s / options.speed});
        Newest& before = place->second;
        if (!first) {
            before.span_s =
                std::min(start_s - turns[before.item].start_s, longest_volume_s / options.speed);
            turns[before.item].span_s = before.span_s;
            before.item = i;
        }
        turns[i].span_s = before.span_s;
    }
    return turns;
}

std::string_view why_not_in_chunks(const ReplayItem& item) {
    if (!item.has_records) return "holds no LDM records";
    if (!item.time) return "has no header with a time";
    if (item.station.empty()) return "neither its header nor its name has a station";
    return {};
}

Result<std::vector<fs::path>> targets_of(const std::vector<ReplayItem>& items, Delivery delivery) {
    std::vector<fs::path> targets;
    std::map<std::string, std::set<int>> numbers;  // numbers in use, by station
    for (const ReplayItem& item : items) {
        if (delivery != Delivery::chunks) {
            targets.push_back(item.name);
            continue;
        }
        const auto refuse = [&item](std::string_view why) {
            return fail(ErrorCode::bad_argument, "{}: {}, so it cannot come in chunks",
                        item.source.native(), why);
        };
        if (const auto why = why_not_in_chunks(item); !why.empty()) return refuse(why);
        std::set<int>& taken = numbers[item.station];
        if (taken.size() == most_numbers) return refuse("the station has 1000 volumes already");
        int number = item.number.value_or(1);
        while (!taken.insert(number).second)
            number = (number + 1) % most_numbers;
        targets.push_back(fs::path(item.station) / std::to_string(number));
    }
    return targets;
}

}  // namespace stormcellar::synth
