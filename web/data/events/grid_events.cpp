#include "web/data/events/grid_events.h"

#include <algorithm>
#include <charconv>
#include <ctime>
#include <optional>
#include <string>
#include <utility>

#include <nlohmann/json.hpp>
#include <sys/stat.h>

#include "base/beneath.h"
#include "pipeline/keep/keep_rule.h"
#include "stormcellar/base/station_table.h"

namespace stormcellar::web {
namespace {

using EventJson = nlohmann::ordered_json;

constexpr std::size_t most_told_remembered = 4;  // of each domain and moment
constexpr std::size_t most_times_listed = 32;

// The numbers in the note of a living grid (the grid of a growing volume), such as "living: 5
// sweeps have come, 9 of the last volume stand" (pipeline/ingest/show_living.cpp).
struct LivingCounts {
    int came = 0, standing = 0;
};
std::optional<LivingCounts> living_counts(const grid::Provenance& provenance) {
    if (!provenance.partial) return std::nullopt;
    for (const std::string& note : provenance.notes) {
        if (!note.starts_with(pipeline::living_note)) continue;
        LivingCounts counts;
        const char* const end = note.data() + note.size();
        const char* at = note.data() + pipeline::living_note.size();
        at = std::from_chars(at, end, counts.came).ptr;
        const std::size_t comma = note.find(", ");
        if (comma != std::string::npos)
            std::from_chars(note.data() + comma + 2, end, counts.standing);
        return counts;
    }
    return std::nullopt;
}

bool is_of_a_site(const std::string& domain, const cache::GridDescription& grid) {
    return grid.provenance.revision == 0 && grid.sites.size() == 1 &&
           grid.sites.front().icao == domain;
}

EventType type_of(bool is_site, bool is_living) {
    if (!is_site) return EventType::mosaic;
    return is_living ? EventType::sweep_gridded : EventType::volume_complete;
}

// Returns the fields that all events of grids have.
EventJson grid_json(EventType type, const cache::GridName& name, const cache::GridFacts& grid,
                    UtcTime now) {
    const std::string moment(level2::moment_name(name.moment));
    const std::string time = format_utc(name.time);
    EventJson json = {{"type", event_name(type)}, {"time", format_utc(now)}};
    if (type != EventType::mosaic) json["station"] = name.domain;
    json.update({{"domain", name.domain},
                 {"moment", moment},
                 {"grid", time},
                 {"path", fmt::format("/api/v1/grids/{}/{}/{}", name.domain, moment, time)},
                 {"id", fmt::format("{:016x}", grid.checksum)},
                 {"data_to", format_utc(grid.description.end_time)}});
    return json;
}

void add_site_facts(const cache::GridDescription& grid, std::optional<LivingCounts> living,
                    EventJson& json) {
    const std::vector<grid::SweepTime>& sweeps = grid.provenance.sweeps;
    if (living) {
        json["sweeps"] = living->came;
        json["standing"] = living->standing;
        const auto newest = std::max_element(
            sweeps.begin(), sweeps.end(),
            [](const auto& one, const auto& other) { return one.start < other.start; });
        if (newest != sweeps.end())
            json["newest_sweep"] = {{"elevation_deg", newest->elevation_deg},
                                    {"start", format_utc(newest->start)}};
        return;
    }
    if (!sweeps.empty()) json["sweeps_used"] = sweeps.size();
    json["partial"] = grid.provenance.partial;
}

std::string dumped(const EventJson& json) {
    return json.dump(-1, ' ', false, EventJson::error_handler_t::replace);
}

}  // namespace

std::int64_t file_clock_ns() {
    timespec now{};
    ::clock_gettime(CLOCK_REALTIME_COARSE, &now);
    return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

bool GridEvents::is_news(const cache::GridName& name, const Told& file) {
    if (file.modified_ns < began_ns_) return false;
    std::vector<Told>& told = told_[{name.domain, name.moment}];
    const auto known = std::find_if(told.begin(), told.end(),
                                    [&](const Told& one) { return one.time == name.time; });
    if (known != told.end() && *known == file) return false;
    if (known != told.end()) told.erase(known);
    if (told.size() == most_told_remembered) told.erase(told.begin());
    told.push_back(file);
    return true;
}

void GridEvents::add_grid(const CacheChange& change, UtcTime now, std::vector<Event>& events) {
    const cache::GridName& name = change.grid;
    const std::filesystem::path& root = grids_->cache();
    const Result<int> opened = open_beneath(root, root / cache::relative_path(name));
    // If the grid is gone again, the change that removed it will report that.
    if (!opened) return;
    const Descriptor file(*opened);
    struct stat facts {};
    if (::fstat(file.number(), &facts) != 0) return;
    const std::int64_t modified_ns =
        std::int64_t{facts.st_mtim.tv_sec} * 1'000'000'000 + facts.st_mtim.tv_nsec;
    if (!is_news(name, {name.time, facts.st_ino, modified_ns})) {
        came_back_ = came_back_ || change.event == CacheEvent::came;
        return;
    }
    const auto grid = cache::read_grid_facts(file);
    if (!grid) {
        ++unreadable_;
        told_[{name.domain, name.moment}].pop_back();
        return;
    }
    const cache::GridDescription& description = grid->description;
    const bool is_site = is_of_a_site(name.domain, description);
    const auto living = living_counts(description.provenance);
    const EventType type = type_of(is_site, living.has_value());
    EventJson json = grid_json(type, name, *grid, now);
    if (is_site) {
        add_site_facts(description, living, json);
        auto heard =
            book_.hear(name.domain, SeenVolume{name.time, description.provenance.vcp}, now, now);
        std::move(heard.begin(), heard.end(), std::back_inserter(events));
    } else {
        json["provisional"] = description.provenance.provisional;
        json["revision"] = description.provenance.revision;
        json["stations"] = description.provenance.stations;
    }
    events.push_back({type, is_site ? name.domain : "", name.domain, name.moment, dumped(json)});
}

void GridEvents::add_evicted(const Place& place, std::vector<UtcTime> times, UtcTime now,
                             std::vector<Event>& events) const {
    const auto& [domain, moment] = place;
    std::sort(times.begin(), times.end());
    const bool is_station = is_icao(domain);
    EventJson json = {{"type", event_name(EventType::grid_evicted)}, {"time", format_utc(now)}};
    if (is_station) json["station"] = domain;
    json.update({{"domain", domain},
                 {"moment", level2::moment_name(moment)},
                 {"count", times.size()},
                 {"from", format_utc(times.front())},
                 {"to", format_utc(times.back())}});
    // List the times if there are only a few. Otherwise give only `from` and `to`.
    if (times.size() <= most_times_listed) {
        json["grids"] = EventJson::array();
        for (const UtcTime time : times)
            json["grids"].push_back(format_utc(time));
    }
    const auto left = grids_->times(domain, moment);
    json["oldest"] = left.empty() ? EventJson() : EventJson(format_utc(left.front()));
    events.push_back(
        {EventType::grid_evicted, is_station ? domain : "", domain, moment, dumped(json)});
}

std::vector<Event> GridEvents::of(std::span<const CacheChange> changes, UtcTime now) {
    std::vector<Event> events;
    std::map<Place, std::vector<UtcTime>> evicted;
    std::map<cache::GridName, const CacheChange*> last;
    bool is_reset = false;
    for (const CacheChange& change : changes) {
        if (change.event == CacheEvent::everything) {
            is_reset = true;
        } else {
            last[change.grid] = &change;
        }
    }
    if (is_reset) events.push_back(reset_event("changes of the cache were missed"));
    for (const CacheChange& change : changes) {
        if (change.event == CacheEvent::everything || last.at(change.grid) != &change) continue;
        if (cache::is_part(change.grid.domain)) continue;
        if (change.event == CacheEvent::went) {
            evicted[{change.grid.domain, change.grid.moment}].push_back(change.grid.time);
        } else {
            add_grid(change, now, events);
        }
    }
    for (auto& [place, times] : evicted)
        add_evicted(place, std::move(times), now, events);
    if (std::exchange(came_back_, false))
        events.push_back(reset_event("grids that were gone are there again"));
    return events;
}

}  // namespace stormcellar::web
