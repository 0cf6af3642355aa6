#include "notify/notice.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "stormcellar/grid/site_frame.h"

namespace stormcellar::notify {
namespace {

using nlohmann::ordered_json;
using retrieve::CellForecast;
using retrieve::TrackedCell;

// A place of the path of a cell, in the plane about the place of the rule.
struct PathPoint {
    grid::PlanePoint at;
    UtcTime time;
    double error_m = 0;
};

std::vector<PathPoint> path_of(const grid::SiteFrame& frame, const TrackedCell& cell) {
    const auto in_plane = [&](grid::GeoPoint point) {
        return grid::SiteFrame::to_plane(frame.to_polar(point));
    };
    std::vector<PathPoint> path = {
        {in_plane(cell.cell.position), cell.time, cell.forecasts.front().error_m}};
    for (const CellForecast& forecast : cell.forecasts)
        path.push_back({in_plane(forecast.position), forecast.time, forecast.error_m});
    return path;
}

// Returns the point between `a` and `b` that is closest to the origin of the plane.
ClosestApproach closest_between(const PathPoint& a, const PathPoint& b) {
    const double dx = b.at.x_m - a.at.x_m, dy = b.at.y_m - a.at.y_m;
    const double length2 = dx * dx + dy * dy;
    const double along =
        length2 > 0 ? std::clamp(-(a.at.x_m * dx + a.at.y_m * dy) / length2, 0.0, 1.0) : 0;
    const std::chrono::milliseconds after{
        std::llround(along * static_cast<double>((b.time - a.time).count()))};
    return {std::hypot(a.at.x_m + along * dx, a.at.y_m + along * dy), a.time + after,
            a.error_m + along * (b.error_m - a.error_m)};
}

bool reaches(const std::optional<double>& least, double value) {
    return !least || value >= *least;
}

// Rounds to tenths. Infinity and NaN become null, because JSON does not have them.
ordered_json tenths(double value) {
    return std::isfinite(value) ? ordered_json(std::round(value * 10) / 10) : ordered_json();
}

ordered_json degrees(double value) {
    return std::round(value * 1e4) / 1e4;
}

ordered_json place_json(const NotifyRule& rule) {
    return {{"latitude_deg", rule.latitude_deg},
            {"longitude_deg", rule.longitude_deg},
            {"radius_km", rule.radius_km}};
}

ordered_json thresholds_json(const Thresholds& thresholds) {
    ordered_json json;
    if (thresholds.max_dbz) json["max_dbz"] = *thresholds.max_dbz;
    if (thresholds.vil_kg_per_m2) json["vil_kg_per_m2"] = *thresholds.vil_kg_per_m2;
    if (thresholds.mesh_mm) json["mesh_mm"] = *thresholds.mesh_mm;
    if (thresholds.top_km) json["top_km"] = *thresholds.top_km;
    return json;
}

ordered_json cell_json(const TrackedCell& tracked, grid::PolarPoint from_place,
                       const retrieve::FreezingLevels& freezing) {
    const retrieve::StormCell& cell = tracked.cell;
    ordered_json json = {{"id", tracked.id},
                         {"origin", retrieve::cell_origin_name(tracked.origin)},
                         {"latitude_deg", degrees(cell.position.latitude_deg)},
                         {"longitude_deg", degrees(cell.position.longitude_deg)},
                         {"distance_km", tenths(from_place.arc_m / 1000)},
                         {"azimuth_from_place_deg", tenths(from_place.azimuth_deg)},
                         {"area_km2", tenths(cell.area_km2)},
                         {"max_dbz", tenths(cell.max_dbz)},
                         {"max_dbz_height_m", std::lround(cell.max_dbz_height_m)},
                         {"top_m", std::lround(cell.top_m)},
                         {"top_is_at_least", cell.top_is_at_least},
                         {"vil_kg_per_m2", tenths(cell.vil_kg_per_m2)}};
    if (cell.mesh_mm) {
        json["mesh_mm"] = tenths(*cell.mesh_mm);
        json["assumed_freezing_levels_m"] = {freezing.zero_c_m, freezing.minus_20_c_m};
    }
    if (tracked.motion) {
        const retrieve::Motion& motion = tracked.motion->velocity;
        json["motion"] = {{"speed_mps", tenths(motion.speed_mps())},
                          {"from_deg", tenths(motion.direction_deg())},
                          {"error_mps", tenths(tracked.motion->error_mps)}};
    }
    return json;
}

std::string text_of(const NotifyRule& rule, const retrieve::TrackedScan& scan,
                    const TrackedCell& cell, grid::PolarPoint from_place,
                    const retrieve::FreezingLevels& freezing, const MessageName& name) {
    ordered_json json = {{"event", "cell"},
                         {"id", name.id()},
                         {"rule", rule.name},
                         {"area", scan.area},
                         {"time", format_utc(scan.time)},
                         {"place", place_json(rule)},
                         {"thresholds", thresholds_json(rule.thresholds)},
                         {"cell", cell_json(cell, from_place, freezing)}};
    if (const auto closest = closest_approach(rule, cell)) {
        json["closest_approach"] = {
            {"time", format_utc(closest->time)},
            {"minutes", std::lround(seconds_between(scan.time, closest->time) / 60)},
            {"distance_km", tenths(closest->distance_m / 1000)},
            {"error_km", tenths(closest->error_m / 1000)}};
    }
    return json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

}  // namespace

std::optional<ClosestApproach> closest_approach(const NotifyRule& rule, const TrackedCell& cell) {
    if (cell.forecasts.empty()) return std::nullopt;
    const auto path = path_of(grid::SiteFrame(rule.latitude_deg, rule.longitude_deg), cell);
    ClosestApproach closest = closest_between(path[0], path[1]);
    for (std::size_t i = 2; i < path.size(); ++i) {
        const ClosestApproach next = closest_between(path[i - 1], path[i]);
        if (next.distance_m < closest.distance_m) closest = next;
    }
    return closest;
}

bool passes(const Thresholds& thresholds, const retrieve::StormCell& cell) {
    constexpr double m_a_km = 1000;
    return reaches(thresholds.max_dbz, cell.max_dbz) &&
           reaches(thresholds.vil_kg_per_m2, cell.vil_kg_per_m2) &&
           reaches(thresholds.top_km, cell.top_m / m_a_km) &&
           (!thresholds.mesh_mm || (cell.mesh_mm && *cell.mesh_mm >= *thresholds.mesh_mm));
}

std::vector<Notice> notices_of(const NotifyRule& rule, const retrieve::TrackedScan& scan,
                               const retrieve::FreezingLevels& freezing,
                               const LastMessage& last_of) {
    const grid::SiteFrame frame(rule.latitude_deg, rule.longitude_deg);
    std::vector<Notice> notices;
    for (const TrackedCell& cell : scan.cells) {
        const grid::PolarPoint from_place = frame.to_polar(cell.cell.position);
        if (from_place.arc_m > rule.radius_km * 1000 || !passes(rule.thresholds, cell.cell))
            continue;
        const auto last = last_of(cell.id);
        if (last && scan.time < *last + rule.every) continue;
        MessageName name{scan.time, cell.id};
        std::string text = text_of(rule, scan, cell, from_place, freezing, name);
        notices.push_back({std::move(name), std::move(text)});
    }
    return notices;
}

}  // namespace stormcellar::notify
