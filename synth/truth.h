// synth/truth.h -- defines an analytic atmosphere: the reflectivity at any point and time, in
// closed form.
//
// Storms and layers drift with constant velocity over a plane. A simulated radar observes this
// truth, and a grid that is made from its data can be compared with it.
//
// Each feature has its own reflectivity, and ends where that is below -20 dBZ. If features overlap,
// their reflectivities are added in mm^6/m^3.
//   storm   peak - (peak - 10) (r^2 + h^2) + ripple
//           r is the distance from the axis in units of the radii. The axis leans with height by
//           `tilt`, and is at (x, y) at the height of the core. h is (z - core) / (top - core)
//           above the core, and 0 below it. So a storm has 10 dBZ at its radii and at its top.
//   hook    dbz - (dbz - 10) ((d / width)^2 + (z / top)^2)
//           d is the horizontal distance from an arc of a circle that moves and leans with its
//           storm.
//   layer   dbz - (dbz - 10) r^4 + bright_band exp(-((z - melting) / depth)^2)
//             - lapse max(0, z - melting) + ripple, only between base and top
//   box     dbz - (dbz - 10) (d / edge)^2 + wave sin(2 pi s / length), only between base and top
//           d is the horizontal distance from the rectangle, and s the distance from its center
//           along an azimuth. So a box is flat, has 10 dBZ at `edge` beyond its sides, and is cut
//           off sharply at its base and its top.
//
// The air that carries the echo moves with the wind if the weather has one, else with its feature.
// The features themselves always drift by their own motions.
//
// Units     As in synth/plane.h; dBZ; t is the time in seconds since the start of the scene.
// Accuracy  The formulas in double.
// Threads   Pure functions.
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "synth/plane.h"
#include "synth/wind.h"

namespace stormcellar::synth {

inline constexpr double edge_dbz = 10;      // reflectivity of a feature at its radii
inline constexpr double weakest_dbz = -20;  // a feature ends below this
// reflectivity outside all features
inline constexpr double no_echo_dbz = -std::numeric_limits<double>::infinity();

// An upright elliptic column that drifts over the plane.
struct Footprint {
    double x_m = 0;  // the center at t = 0
    double y_m = 0;
    Motion motion;
    double major_m = 10000;  // half axes
    double minor_m = 10000;
    double orientation_deg = 0;  // azimuth of the major axis
};

// A smooth pattern that moves with its feature: the mean of three waves with different directions.
struct Ripple {
    double most_db = 0;  // largest change, up or down
    double length_m = 5000;
    double turn_deg = 0;  // the directions of the waves, clockwise
};

// The arc of a hook echo, as seen from the axis of its storm.
struct Hook {
    double x_m = 0;  // center of the circle, east and north of the axis
    double y_m = 0;
    double radius_m = 5000;
    double from_deg = 0;  // the arc runs clockwise between these azimuths
    double to_deg = 270;
    double width_m = 1500;
    double top_m = 5000;
    double peak_dbz = 50;
};

struct Storm {
    Footprint footprint;
    double core_m = 4000;
    double top_m = 12000;
    double peak_dbz = 50;
    double tilt_east = 0;  // meters of lean for each meter of height
    double tilt_north = 0;
    Ripple ripple;
    std::optional<Hook> hook;
};

struct Layer {
    Footprint footprint;
    double base_m = 0;
    double top_m = 8000;
    double peak_dbz = 25;  // below the melting level, without the bright band
    double melting_m = 3500;
    double bright_band_db = 0;
    double bright_band_depth_m = 300;
    double lapse_db_per_m = 0.003;  // above the melting level
    Ripple ripple;
};

// Stripes across a box, which move with the box.
struct Wave {
    double most_db = 0;
    double length_m = 10000;
    double azimuth_deg = 90;  // across the stripes
};

// A plateau with sides of any steepness. The half axes of its footprint are half of its sides.
struct Box {
    Footprint footprint;
    double base_m = 0;
    double top_m = 8000;
    double peak_dbz = 40;
    double edge_m = 500;
    Wave wave;
};

struct Weather {
    std::vector<Storm> storms;
    std::vector<Layer> layers;
    std::vector<Box> boxes = {};
    std::optional<Wind> wind = {};
};

// Returns the same weather in the plane about the radar at `stand`, as if both planes were one. The
// error is the difference of their scales across the radius, (arc / earth radius)^2 / 6. The error
// is 50 m if the radars are 200 km apart.
[[nodiscard]] Weather seen_from(const Weather& weather, const Stand& stand);

// Returns the reflectivity; minus infinity if there is nothing.
[[nodiscard]] double truth_dbz(const Weather& weather, const Point& point, double t_s);

// The reflectivity at a point, and the motion of the air there. The motion is the wind, or, if the
// weather has none, the mean motion of the features, weighted by their reflectivities in mm^6/m^3.
// The motion is zero without echo.
struct Echo {
    double dbz = 0;
    Motion motion;
};
[[nodiscard]] Echo truth(const Weather& weather, const Point& point, double t_s);

// An echo with its reflectivity in mm^6/m^3, which is 0 if there is nothing.
struct LinearEcho {
    double z_mm6_m3 = 0;
    Motion motion;
};
[[nodiscard]] LinearEcho linear_truth(const Weather& weather, const Point& point, double t_s);

// Discs, one for each feature, that contain all echo at a time, at all heights. Outside them,
// truth_dbz() is minus infinity.
struct Disc {
    double x_m = 0;
    double y_m = 0;
    double radius_m = 0;
};
[[nodiscard]] std::vector<Disc> echo_discs(const Weather& weather, double t_s);

// Returns a height that no echo exceeds at any time.
[[nodiscard]] double echo_ceiling_m(const Weather& weather);

}  // namespace stormcellar::synth
