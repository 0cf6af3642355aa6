#include "fetch/feed/feed_status.h"

#include <nlohmann/json.hpp>

#include "stormcellar/base/version.h"

namespace stormcellar::feed {
namespace {

using nlohmann::ordered_json;

ordered_json time_json(const std::optional<UtcTime>& time) {
    return time ? ordered_json(format_utc(*time)) : ordered_json();
}

const char* state_of(const StationStatus& station) {
    if (!station.error.empty()) return "failing";
    if (!station.answered) return "starting";
    if (station.is_searching && !station.is_silent) return "searching";
    return station.is_silent ? "silent" : "following";
}

}  // namespace

std::string status_text(const FeedStatus& status, UtcTime now) {
    ordered_json list = ordered_json::array();
    for (const StationStatus& station : status.stations) {
        const auto& volume = station.volume;
        list.push_back({{"station", station.station},
                        {"state", state_of(station)},
                        {"error", station.error},
                        {"answered", time_json(station.answered)},
                        {"next_try", time_json(station.next_try)},
                        {"volume", volume ? ordered_json(volume->number) : ordered_json()},
                        {"volume_time", volume ? time_json(volume->time) : ordered_json()},
                        {"chunk", station.chunk},
                        {"written_at", time_json(station.written_at)},
                        {"written", station.written},
                        {"present", station.present},
                        {"refused", station.refused},
                        {"missing", station.missing},
                        {"listings", station.listings},
                        {"failures", station.failures}});
    }
    const ordered_json all = {{"time", format_utc(now)},   {"version", software_version},
                              {"bucket", status.bucket},   {"drop", status.drop},
                              {"bytes", status.bytes},     {"volumes", status.volumes},
                              {"removed", status.removed}, {"stations", std::move(list)}};
    return all.dump(1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace stormcellar::feed
