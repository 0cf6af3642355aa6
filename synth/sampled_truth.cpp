#include "synth/sampled_truth.h"

#include <chrono>
#include <cmath>

#include "base/degree.h"
#include "stormcellar/grid/beam_geometry.h"
#include "stormcellar/grid/site_frame.h"

namespace stormcellar::synth {
namespace {

double elevation_cosine(const Place& site, double arc_m, double height_m) {
    const grid::BeamGeometry beam(site.latitude_deg, site.height_m);
    return std::cos(beam.inverse({arc_m, height_m}).elevation_deg * degree);
}

}  // namespace

double SampledTruth::seconds_at(UtcTime time) const {
    return std::chrono::duration<double>(time - scene_.schedule.start).count();
}

Point SampledTruth::point_of(const Place& place) const {
    const grid::SiteFrame frame(scene_.site.latitude_deg, scene_.site.longitude_deg);
    const auto polar = frame.to_polar({place.latitude_deg, place.longitude_deg});
    return point_of(PolarPlace{polar.azimuth_deg, polar.arc_m, place.height_m});
}

Point SampledTruth::point_of(const PolarPlace& place) {
    return {place.arc_m * std::sin(place.azimuth_deg * degree),
            place.arc_m * std::cos(place.azimuth_deg * degree), place.height_m};
}

Echo SampledTruth::at(const Place& place, UtcTime time) const {
    return truth(scene_.weather, point_of(place), seconds_at(time));
}

Echo SampledTruth::at(const PolarPlace& place, UtcTime time) const {
    return truth(scene_.weather, point_of(place), seconds_at(time));
}

std::optional<double> SampledTruth::radial_velocity_mps(const Place& place, const Place& site,
                                                        UtcTime time) const {
    const Echo echo = at(place, time);
    if (std::isinf(echo.dbz)) return std::nullopt;
    const Point there = point_of(place);
    const Point here = point_of(site);
    const double east_m = there.x_m - here.x_m;
    const double north_m = there.y_m - here.y_m;
    const double apart_m = std::hypot(east_m, north_m);
    if (apart_m <= 0) return 0;  // straight above, all motion is across the beam
    const grid::SiteFrame frame(site.latitude_deg, site.longitude_deg);
    const double arc_m = frame.to_polar({place.latitude_deg, place.longitude_deg}).arc_m;
    return (echo.motion.east_mps * east_m + echo.motion.north_mps * north_m) / apart_m *
           elevation_cosine(site, arc_m, place.height_m);
}

std::optional<double> SampledTruth::radial_velocity_mps(const PolarPlace& place,
                                                        UtcTime time) const {
    const Echo echo = at(place, time);
    if (std::isinf(echo.dbz)) return std::nullopt;
    const Site& own = scene_.site;
    const Place site{own.latitude_deg, own.longitude_deg,
                     static_cast<double>(own.antenna_altitude_m)};
    const double azimuth = place.azimuth_deg * degree;
    return (echo.motion.east_mps * std::sin(azimuth) + echo.motion.north_mps * std::cos(azimuth)) *
           elevation_cosine(site, place.arc_m, place.height_m);
}

}  // namespace stormcellar::synth
