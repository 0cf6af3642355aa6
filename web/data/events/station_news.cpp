#include "web/data/events/station_news.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

namespace stormcellar::web {
namespace {

// Two starts that differ by less than this are of one volume. Until the header of a volume comes,
// its start is the time of its first radial. The start in the header differs from this time by up
// to ten seconds.
constexpr std::chrono::seconds same_volume_within{15};

Event station_event(EventType type, const std::string& station, UtcTime now,
                    const nlohmann::ordered_json& more) {
    nlohmann::ordered_json json = {
        {"type", event_name(type)}, {"time", format_utc(now)}, {"station", station}};
    json.update(more);
    return {type, station, station, std::nullopt, json.dump()};
}

nlohmann::ordered_json time_or_null(std::optional<UtcTime> time) {
    return time ? nlohmann::ordered_json(format_utc(*time)) : nlohmann::ordered_json();
}

}  // namespace

Event volume_ended_event(const std::string& station, const EndedVolume& volume, UtcTime now) {
    return station_event(EventType::volume_complete, station, now,
                         {{"volume", format_utc(volume.start)},
                          {"sweeps", volume.sweeps},
                          {"partial", !volume.is_complete}});
}

void StationNews::note(const std::string& station, std::optional<UtcTime> newest_volume,
                       std::optional<UtcTime> heard, UtcTime now) {
    const MutexLock lock(mutex_);
    Page& page = pages_[station];
    page.station = station;
    if (newest_volume && is_believed(*newest_volume, now))
        page.newest_volume = std::max(page.newest_volume.value_or(*newest_volume), *newest_volume);
    if (heard) page.heard = std::max(page.heard.value_or(*heard), std::min(*heard, now));
    page.is_silent = !page.spoke() || now - *page.spoke() > silent_after_;
}

std::vector<Event> StationNews::hear(const std::string& station, std::optional<SeenVolume> volume,
                                     UtcTime heard, UtcTime now) {
    std::vector<Event> events;
    const MutexLock lock(mutex_);
    const auto [at, is_new] = pages_.try_emplace(station);
    Page& page = at->second;
    page.station = station;
    heard = std::min(heard, now);
    page.heard = std::max(page.heard.value_or(heard), heard);
    if (page.is_silent && now - *page.heard <= silent_after_) {
        page.is_silent = false;
        events.push_back(station_event(EventType::station_spoke, station, now,
                                       {{"newest_volume", time_or_null(page.newest_volume)}}));
    }
    if (!volume || !is_believed(volume->start, now)) return events;
    if (page.newest_volume && volume->start <= *page.newest_volume + same_volume_within)
        return events;
    page.newest_volume = volume->start;
    nlohmann::ordered_json facts = {{"volume", format_utc(volume->start)}};
    if (volume->vcp != 0) facts["vcp"] = volume->vcp;
    events.push_back(station_event(EventType::volume_begun, station, now, facts));
    return events;
}

std::vector<Event> StationNews::look(UtcTime now) {
    std::vector<Event> events;
    const MutexLock lock(mutex_);
    for (auto& [station, page] : pages_) {
        // The clock may have been set back.
        if (page.heard) page.heard = std::min(*page.heard, now);
        if (page.is_silent || !page.spoke() || now - *page.spoke() <= silent_after_) continue;
        page.is_silent = true;
        events.push_back(
            station_event(EventType::station_silent, station, now,
                          {{"silent_s", std::floor(seconds_between(*page.spoke(), now))},
                           {"newest_volume", time_or_null(page.newest_volume)}}));
    }
    return events;
}

std::vector<StationNews::Page> StationNews::pages() const {
    const MutexLock lock(mutex_);
    std::vector<Page> all;
    all.reserve(pages_.size());
    for (const auto& [station, page] : pages_)
        all.push_back(page);
    return all;
}

}  // namespace stormcellar::web
