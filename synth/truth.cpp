#include "synth/truth.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/degree.h"

namespace stormcellar::synth {
namespace {

constexpr double nothing = -std::numeric_limits<double>::infinity();

double square(double number) {
    return number * number;
}

// Moves a footprint into the plane of a radar at `stand`.
void move(Footprint& footprint, const Stand& stand) {
    const Offset place = place_from(stand, footprint.x_m, footprint.y_m);
    footprint.x_m = place.east_m;
    footprint.y_m = place.north_m;
    footprint.motion = motion_from(stand, footprint.motion);
    footprint.orientation_deg -= stand.turn_deg;
}

void move(Storm& storm, const Stand& stand) {
    move(storm.footprint, stand);
    const Offset tilt = turned({storm.tilt_east, storm.tilt_north}, -stand.turn_deg);
    storm.tilt_east = tilt.east_m;
    storm.tilt_north = tilt.north_m;
    storm.ripple.turn_deg -= stand.turn_deg;
    if (!storm.hook) return;
    const Offset center = turned({storm.hook->x_m, storm.hook->y_m}, -stand.turn_deg);
    storm.hook->x_m = center.east_m;
    storm.hook->y_m = center.north_m;
    storm.hook->from_deg -= stand.turn_deg;
    storm.hook->to_deg -= stand.turn_deg;
}

// Returns the offset of a point from the center of a footprint that leans by `lean`.
Offset offset_from(const Footprint& footprint, const Point& point, double t_s,
                   const Offset& lean = {}) {
    return {point.x_m - footprint.x_m - footprint.motion.east_mps * t_s - lean.east_m,
            point.y_m - footprint.y_m - footprint.motion.north_mps * t_s - lean.north_m};
}

// Returns a lower bound of squared_radii(): the result if the larger axis applied in all
// directions. This is enough for most points, and saves the rotation.
double least_squared_radii(const Footprint& footprint, const Offset& offset) {
    return (square(offset.east_m) + square(offset.north_m)) /
           square(std::max(footprint.major_m, footprint.minor_m));
}

// Returns the squared distance from the center in units of the half axes.
double squared_radii(const Footprint& footprint, const Offset& offset) {
    const double sine = std::sin(footprint.orientation_deg * degree);
    const double cosine = std::cos(footprint.orientation_deg * degree);
    const double along_m = offset.east_m * sine + offset.north_m * cosine;
    const double across_m = offset.east_m * cosine - offset.north_m * sine;
    return square(along_m / footprint.major_m) + square(across_m / footprint.minor_m);
}

Offset lean_of(const Storm& storm, double z_m) {
    return {storm.tilt_east * (z_m - storm.core_m), storm.tilt_north * (z_m - storm.core_m)};
}

// Returns the mean of three sines that run in different directions and never repeat together.
double ripple_db(const Ripple& ripple, const Offset& offset, double z_m) {
    if (ripple.most_db == 0) return 0;
    const double scale = 2 * std::numbers::pi / ripple.length_m;
    const Offset own = ripple.turn_deg == 0 ? offset : turned(offset, -ripple.turn_deg);
    const double a = std::sin(scale * (own.east_m + 0.31 * own.north_m + 0.4 * z_m));
    const double b = std::sin(scale * (0.618 * own.north_m - 0.382 * own.east_m) + 1.1);
    const double c = std::sin(scale * (0.23 * own.east_m + 1.37 * own.north_m) + 2.3);
    return ripple.most_db * (a + b + c) / 3;
}

double storm_dbz(const Storm& storm, const Offset& offset, double z_m) {
    const double height = std::max(0.0, z_m - storm.core_m) / (storm.top_m - storm.core_m);
    const double depth_db = storm.peak_dbz - edge_dbz;
    const double most_db = storm.peak_dbz + storm.ripple.most_db - depth_db * square(height);
    if (most_db - depth_db * least_squared_radii(storm.footprint, offset) < weakest_dbz) {
        return nothing;
    }
    const double fall = squared_radii(storm.footprint, offset) + square(height);
    return storm.peak_dbz - depth_db * fall + ripple_db(storm.ripple, offset, z_m);
}

// `from_center_m` is the point's distance from the center of the circle.
double distance_to_arc(const Hook& hook, double east_m, double north_m, double from_center_m) {
    const double azimuth_deg = std::atan2(east_m, north_m) / degree;
    // The turn is 0 to 360, clockwise from the beginning of the arc.
    const double turn_deg =
        azimuth_deg - hook.from_deg - 360 * std::floor((azimuth_deg - hook.from_deg) / 360);
    if (turn_deg <= hook.to_deg - hook.from_deg) return std::abs(from_center_m - hook.radius_m);
    const auto distance_to_end = [&](double end_deg) {
        return std::hypot(east_m - hook.radius_m * std::sin(end_deg * degree),
                          north_m - hook.radius_m * std::cos(end_deg * degree));
    };
    return std::min(distance_to_end(hook.from_deg), distance_to_end(hook.to_deg));
}

double hook_dbz(const Hook& hook, const Offset& offset, double z_m) {
    const double east_m = offset.east_m - hook.x_m;
    const double north_m = offset.north_m - hook.y_m;
    const double from_center_m = std::hypot(east_m, north_m);
    const auto dbz_at = [&](double distance_m) {
        const double fall = square(distance_m / hook.width_m) + square(z_m / hook.top_m);
        return hook.peak_dbz - (hook.peak_dbz - edge_dbz) * fall;
    };
    // The arc is at least as far away as its circle, whose distance is quick to compute.
    if (dbz_at(from_center_m - hook.radius_m) < weakest_dbz) return nothing;
    return dbz_at(distance_to_arc(hook, east_m, north_m, from_center_m));
}

double layer_dbz(const Layer& layer, const Point& point, double t_s) {
    if (point.z_m < layer.base_m || point.z_m > layer.top_m) return nothing;
    const Offset offset = offset_from(layer.footprint, point, t_s);
    const double depth_db = layer.peak_dbz - edge_dbz;
    const double most_db = layer.peak_dbz + layer.bright_band_db + layer.ripple.most_db;
    if (most_db - depth_db * square(least_squared_radii(layer.footprint, offset)) < weakest_dbz) {
        return nothing;
    }
    const double radii2 = squared_radii(layer.footprint, offset);
    const double above_m = point.z_m - layer.melting_m;
    const double flat_dbz =
        layer.peak_dbz - depth_db * square(radii2) - layer.lapse_db_per_m * std::max(0.0, above_m);
    if (flat_dbz + layer.bright_band_db + layer.ripple.most_db < weakest_dbz) return nothing;
    return flat_dbz +
           layer.bright_band_db * std::exp(-square(above_m / layer.bright_band_depth_m)) +
           ripple_db(layer.ripple, offset, point.z_m);
}

double box_dbz(const Box& box, const Point& point, double t_s) {
    if (point.z_m < box.base_m || point.z_m > box.top_m) return nothing;
    const Offset offset = offset_from(box.footprint, point, t_s);
    const double sine = std::sin(box.footprint.orientation_deg * degree);
    const double cosine = std::cos(box.footprint.orientation_deg * degree);
    const double along_m = std::abs(offset.east_m * sine + offset.north_m * cosine);
    const double across_m = std::abs(offset.east_m * cosine - offset.north_m * sine);
    const double squared_distance = square(std::max(0.0, along_m - box.footprint.major_m)) +
                                    square(std::max(0.0, across_m - box.footprint.minor_m));
    const double flat_dbz =
        box.peak_dbz - (box.peak_dbz - edge_dbz) * squared_distance / square(box.edge_m);
    if (box.wave.most_db == 0 || flat_dbz + box.wave.most_db < weakest_dbz) return flat_dbz;
    const double way_m = offset.east_m * std::sin(box.wave.azimuth_deg * degree) +
                         offset.north_m * std::cos(box.wave.azimuth_deg * degree);
    return flat_dbz + box.wave.most_db * std::sin(2 * std::numbers::pi * way_m / box.wave.length_m);
}

// Adds up the reflectivities of features in mm^6/m^3, and the motions of the features, weighted by
// their reflectivities.
class Sum {
  public:
    void add(double dbz, const Motion& motion) {
        if (dbz < weakest_dbz) return;
        const double z = std::pow(10.0, dbz / 10);
        z_ += z;
        east_ += z * motion.east_mps;
        north_ += z * motion.north_mps;
    }
    [[nodiscard]] Echo echo() const {
        if (z_ == 0) return {nothing, {}};
        return {10 * std::log10(z_), {east_ / z_, north_ / z_}};
    }
    [[nodiscard]] LinearEcho linear() const {
        if (z_ == 0) return {};
        return {z_, {east_ / z_, north_ / z_}};
    }

  private:
    double z_ = 0;
    double east_ = 0;
    double north_ = 0;
};

// Returns how far a feature reaches before it ends, in units of its radii.
double reach(double peak_dbz, double extra_db) {
    return (peak_dbz + extra_db - weakest_dbz) / (peak_dbz - edge_dbz);
}

double hook_reach_m(const Hook& hook) {
    return std::hypot(hook.x_m, hook.y_m) + hook.radius_m +
           hook.width_m * std::sqrt(reach(hook.peak_dbz, 0));
}

double hook_ceiling_m(const Hook& hook) {
    return hook.top_m * std::sqrt(reach(hook.peak_dbz, 0));
}

double storm_ceiling_m(const Storm& storm) {
    const double own_m = storm.core_m + (storm.top_m - storm.core_m) *
                                            std::sqrt(reach(storm.peak_dbz, storm.ripple.most_db));
    return storm.hook ? std::max(own_m, hook_ceiling_m(*storm.hook)) : own_m;
}

// The lowest height that counts, below all sites.
constexpr double floor_m = -500;

Disc storm_disc(const Storm& storm, double t_s) {
    double radius_m = std::max(storm.footprint.major_m, storm.footprint.minor_m) *
                      std::sqrt(reach(storm.peak_dbz, storm.ripple.most_db));
    if (storm.hook) radius_m = std::max(radius_m, hook_reach_m(*storm.hook));
    const double highest_m = storm_ceiling_m(storm) - storm.core_m;
    const double lowest_m = storm.core_m - floor_m;
    radius_m +=
        std::hypot(storm.tilt_east, storm.tilt_north) * std::max({highest_m, lowest_m, 0.0});
    const Footprint& footprint = storm.footprint;
    return {footprint.x_m + footprint.motion.east_mps * t_s,
            footprint.y_m + footprint.motion.north_mps * t_s, radius_m};
}

Disc layer_disc(const Layer& layer, double t_s) {
    const Footprint& footprint = layer.footprint;
    const double radii =
        std::pow(reach(layer.peak_dbz, layer.bright_band_db + layer.ripple.most_db), 0.25);
    return {footprint.x_m + footprint.motion.east_mps * t_s,
            footprint.y_m + footprint.motion.north_mps * t_s,
            std::max(footprint.major_m, footprint.minor_m) * radii};
}

Disc box_disc(const Box& box, double t_s) {
    const Footprint& footprint = box.footprint;
    return {footprint.x_m + footprint.motion.east_mps * t_s,
            footprint.y_m + footprint.motion.north_mps * t_s,
            std::hypot(footprint.major_m, footprint.minor_m) +
                box.edge_m * std::sqrt(reach(box.peak_dbz, box.wave.most_db))};
}

Sum sum_at(const Weather& weather, const Point& point, double t_s) {
    Sum sum;
    for (const Storm& storm : weather.storms) {
        const Offset offset = offset_from(storm.footprint, point, t_s, lean_of(storm, point.z_m));
        sum.add(storm_dbz(storm, offset, point.z_m), storm.footprint.motion);
        if (storm.hook) sum.add(hook_dbz(*storm.hook, offset, point.z_m), storm.footprint.motion);
    }
    for (const Layer& layer : weather.layers) {
        sum.add(layer_dbz(layer, point, t_s), layer.footprint.motion);
    }
    for (const Box& box : weather.boxes) {
        sum.add(box_dbz(box, point, t_s), box.footprint.motion);
    }
    return sum;
}

}  // namespace

Weather seen_from(const Weather& weather, const Stand& stand) {
    Weather there = weather;
    for (Storm& storm : there.storms)
        move(storm, stand);
    for (Layer& layer : there.layers) {
        move(layer.footprint, stand);
        layer.ripple.turn_deg -= stand.turn_deg;
    }
    for (Box& box : there.boxes) {
        move(box.footprint, stand);
        box.wave.azimuth_deg -= stand.turn_deg;
    }
    if (there.wind) there.wind = seen_from(*there.wind, stand);
    return there;
}

Echo truth(const Weather& weather, const Point& point, double t_s) {
    Echo echo = sum_at(weather, point, t_s).echo();
    if (weather.wind && echo.dbz > nothing) echo.motion = wind_at(*weather.wind, point, t_s);
    return echo;
}

LinearEcho linear_truth(const Weather& weather, const Point& point, double t_s) {
    LinearEcho echo = sum_at(weather, point, t_s).linear();
    if (weather.wind && echo.z_mm6_m3 > 0) echo.motion = wind_at(*weather.wind, point, t_s);
    return echo;
}

double truth_dbz(const Weather& weather, const Point& point, double t_s) {
    return truth(weather, point, t_s).dbz;
}

std::vector<Disc> echo_discs(const Weather& weather, double t_s) {
    std::vector<Disc> discs;
    for (const Storm& storm : weather.storms) {
        discs.push_back(storm_disc(storm, t_s));
    }
    for (const Layer& layer : weather.layers) {
        discs.push_back(layer_disc(layer, t_s));
    }
    for (const Box& box : weather.boxes) {
        discs.push_back(box_disc(box, t_s));
    }
    return discs;
}

double echo_ceiling_m(const Weather& weather) {
    double ceiling_m = -std::numeric_limits<double>::infinity();
    for (const Storm& storm : weather.storms) {
        ceiling_m = std::max(ceiling_m, storm_ceiling_m(storm));
    }
    for (const Layer& layer : weather.layers) {
        ceiling_m = std::max(ceiling_m, layer.top_m);
    }
    for (const Box& box : weather.boxes) {
        ceiling_m = std::max(ceiling_m, box.top_m);
    }
    return ceiling_m;
}

}  // namespace stormcellar::synth
