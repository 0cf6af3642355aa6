#include "web/data/storms/storm_areas.h"

#include <algorithm>

#include "stormcellar/base/station_table.h"
#include "stormcellar/cache/grid_name.h"

namespace stormcellar::web {
namespace {

constexpr std::size_t most_area_text = 80;

// Returns the time of the area's newest grid that is not after the instant, or none.
std::optional<UtcTime> newest_until(const Grids& grids, const std::string& name,
                                    const StormQuery& query) {
    if (!query.at) return grids.newest(name, query.moment);
    const auto times = grids.times(name, query.moment, *query.at - storm_recent, *query.at);
    return times.empty() ? std::nullopt : std::optional(times.back());
}

// Reads the number of changes before the times, so that a change between the two reads is noticed
// the next time.
StormArea area_until(const Grids& grids, const std::string& name, std::optional<UtcTime> newest,
                     const StormQuery& query) {
    StormArea area{name, {}, grids.changes_of(cache::group_of(name))};
    if (!newest) return area;
    area.times = grids.times(name, query.moment, *newest - storm_history, *newest);
    if (area.times.size() > most_storm_grids) {
        area.times.erase(area.times.begin(), area.times.end() - most_storm_grids);
    }
    return area;
}

struct AreaNewest {
    std::string name;
    UtcTime newest;
};

std::vector<AreaNewest> recent_areas(const Grids& grids, const StormQuery& query) {
    std::vector<AreaNewest> all;
    std::vector<UtcTime> times;
    for (const std::string& name : grids.domains()) {
        if (cache::is_part(name)) continue;
        if (const auto newest = newest_until(grids, name, query)) {
            all.push_back({name, *newest});
            times.push_back(*newest);
        }
    }
    if (all.empty()) return all;
    std::ranges::sort(times);
    const UtcTime instant = query.at.value_or(newest_believed(times));
    std::erase_if(all, [&](const AreaNewest& area) {
        return area.newest > instant || instant - area.newest > storm_recent;
    });
    const auto is_station = [](const AreaNewest& area) { return is_icao(area.name); };
    if (!std::ranges::all_of(all, is_station)) std::erase_if(all, is_station);
    return all;
}

}  // namespace

Result<std::vector<StormArea>> storm_areas(const Grids& grids, const StormQuery& query) {
    std::vector<StormArea> areas;
    const std::string_view moment = level2::moment_name(query.moment);
    if (query.area) {
        if (!grids.newest(*query.area, query.moment)) {
            return fail(ErrorCode::not_found, "area: there is no grid of {} in '{}'", moment,
                        query.area->substr(0, most_area_text));
        }
        const auto newest = newest_until(grids, *query.area, query);
        areas.push_back(area_until(grids, *query.area, newest, query));
        return areas;
    }
    const auto recent = recent_areas(grids, query);
    if (recent.size() > most_storm_areas) {
        return fail(ErrorCode::bad_argument, "area: {} areas have recent grids of {}; name one",
                    recent.size(), moment);
    }
    for (const AreaNewest& area : recent)
        areas.push_back(area_until(grids, area.name, area.newest, query));
    return areas;
}

}  // namespace stormcellar::web
