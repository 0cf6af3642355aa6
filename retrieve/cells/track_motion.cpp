#include "retrieve/cells/track_motion.h"

#include <array>
#include <cmath>

namespace stormcellar::retrieve {
namespace {

constexpr double assumed_freedom = 4;

// Fits x = a + u t and y = b + v t with the same errors. Needs two different times.
std::optional<TrackMotion> line_through(std::span<const CellSighting> sightings,
                                        double position_error_m) {
    const auto n = static_cast<double>(sightings.size());
    if (n < 2) return std::nullopt;
    const CellSighting& newest = sightings.back();
    const grid::SiteFrame plane(newest.position.latitude_deg, newest.position.longitude_deg);
    double t_mean = 0, x_mean = 0, y_mean = 0;
    std::vector<std::array<double, 3>> points;
    for (const CellSighting& sighting : sightings) {
        const auto place = grid::SiteFrame::to_plane(plane.to_polar(sighting.position));
        points.push_back({seconds_between(newest.time, sighting.time), place.x_m, place.y_m});
        t_mean += points.back()[0] / n;
        x_mean += points.back()[1] / n;
        y_mean += points.back()[2] / n;
    }
    double tt = 0, tx = 0, ty = 0;
    for (const auto& [t, x, y] : points) {
        tt += (t - t_mean) * (t - t_mean);
        tx += (t - t_mean) * (x - x_mean);
        ty += (t - t_mean) * (y - y_mean);
    }
    if (!(tt > 0)) return std::nullopt;
    const double u = tx / tt, v = ty / tt;
    double squares = assumed_freedom * position_error_m * position_error_m;
    for (const auto& [t, x, y] : points) {
        const double dx = x - x_mean - u * (t - t_mean), dy = y - y_mean - v * (t - t_mean);
        squares += dx * dx + dy * dy;
    }
    const double variance = squares / (assumed_freedom + 2 * (n - 2));
    return TrackMotion{{u, v}, std::sqrt(variance / tt)};
}

}  // namespace

std::optional<TrackMotion> motion_of_track(std::span<const CellSighting> sightings,
                                           const std::optional<TrackMotion>& prior,
                                           double position_error_m) {
    const auto line = line_through(sightings, position_error_m);
    if (!line) return prior;
    if (!prior) return line;
    const double line_weight = 1 / (line->error_mps * line->error_mps);
    const double prior_weight = 1 / (prior->error_mps * prior->error_mps);
    const double sum = line_weight + prior_weight;
    const auto join = [&](double of_line, double of_prior) {
        return (line_weight * of_line + prior_weight * of_prior) / sum;
    };
    return TrackMotion{{join(line->velocity.u_mps, prior->velocity.u_mps),
                        join(line->velocity.v_mps, prior->velocity.v_mps)},
                       1 / std::sqrt(sum)};
}

grid::GeoPoint moved_place(grid::GeoPoint place, const Motion& motion, double seconds) {
    return grid::SiteFrame(place.latitude_deg, place.longitude_deg)
        .to_geo(grid::SiteFrame::from_plane(motion.u_mps * seconds, motion.v_mps * seconds));
}

std::vector<CellForecast> forecast_track(const CellSighting& newest, const TrackMotion& motion,
                                         double position_error_m) {
    std::vector<CellForecast> forecasts;
    for (const int minutes : forecast_minutes) {
        const double seconds = 60.0 * minutes;
        forecasts.push_back(
            {minutes, newest.time + std::chrono::minutes(minutes),
             moved_place(newest.position, motion.velocity, seconds),
             std::hypot(position_error_m, motion.error_mps * seconds, own_change_mps * seconds)});
    }
    return forecasts;
}

}  // namespace stormcellar::retrieve
