#include "web/data/storms/cell_events.h"

#include <exception>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "stormcellar/base/station_table.h"

namespace stormcellar::web {
namespace {

Event cells_event(const retrieve::CellScan& scan, UtcTime now) {
    nlohmann::ordered_json json = {{"type", event_name(EventType::cells)},
                                   {"time", format_utc(now)}};
    const bool is_station = is_icao(scan.area);
    if (is_station) json["station"] = scan.area;
    json.update({{"domain", scan.area},
                 {"grid", format_utc(scan.time)},
                 {"count", scan.cells.size()},
                 {"path", "/api/v1/cells?area=" + encoded(scan.area)}});
    if (!scan.cells.empty()) json["max_dbz"] = scan.cells.front().max_dbz;
    return {EventType::cells, is_station ? scan.area : "", scan.area, level2::Moment::ref,
            json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace)};
}

}  // namespace

void CellEvents::hear(const std::string& area) {
    {
        const MutexLock lock(mutex_);
        if (!waiting_.insert(area).second) return;
    }
    const bool is_taken = workers_.add(area, [this, area](WorkQueue::Turn turn) {
        {
            const MutexLock lock(mutex_);
            waiting_.erase(area);
        }
        if (turn != WorkQueue::Turn::came) return;
        try {
            search(area);
        } catch (const std::exception&) {
            // Memory is short. The next grid of the area gives an event.
        }
    });
    if (is_taken) return;
    const MutexLock lock(mutex_);
    waiting_.erase(area);
}

void CellEvents::search(const std::string& area) {
    const auto areas = storm_areas(*scans_->grids(), {.area = area});
    if (!areas || areas->front().times.empty()) return;
    const std::vector<UtcTime>& times = areas->front().times;
    const auto before = times.size() > 1 ? std::optional(times[times.size() - 2]) : std::nullopt;
    const auto scan = scans_->scan(area, times.back(), before);
    if (!scan) return;
    {
        const MutexLock lock(mutex_);
        if (std::exchange(told_[area], *scan) == *scan) return;
    }
    hub_->publish(cells_event(**scan, now_utc()));
}

}  // namespace stormcellar::web
