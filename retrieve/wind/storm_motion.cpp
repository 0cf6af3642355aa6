#include "stormcellar/retrieve/storm_motion.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/degree.h"
#include "base/number_list.h"

namespace stormcellar::retrieve {
namespace {

constexpr double deviation_mps = 7.5;
constexpr double mean_top_m = 6'000, tail_top_m = 500, head_bottom_m = 5'500;
constexpr double most_layer_gap_m = 1'500;
constexpr double least_shear_mps = 0.1;
constexpr double most_speed_mps = 100;

// Returns the wind at a height, linear between the given winds.
Motion wind_at(std::span<const WindAtHeight> winds, double height_m) {
    const auto above = std::ranges::lower_bound(winds, height_m, {}, &WindAtHeight::height_m);
    if (above == winds.begin()) return winds.front().wind;
    if (above == winds.end()) return winds.back().wind;
    const WindAtHeight& below = *(above - 1);
    const double part = (height_m - below.height_m) / (above->height_m - below.height_m);
    return {below.wind.u_mps + part * (above->wind.u_mps - below.wind.u_mps),
            below.wind.v_mps + part * (above->wind.v_mps - below.wind.v_mps)};
}

// Returns the mean over height of the piecewise linear wind.
Motion mean_wind(std::span<const WindAtHeight> winds, double bottom_m, double top_m) {
    std::vector<double> heights = {bottom_m};
    for (const WindAtHeight& wind : winds)
        if (wind.height_m > bottom_m && wind.height_m < top_m) heights.push_back(wind.height_m);
    heights.push_back(top_m);
    Motion sum;
    for (std::size_t i = 1; i < heights.size(); ++i) {
        const Motion low = wind_at(winds, heights[i - 1]), high = wind_at(winds, heights[i]);
        const double depth = heights[i] - heights[i - 1];
        sum.u_mps += (low.u_mps + high.u_mps) / 2 * depth;
        sum.v_mps += (low.v_mps + high.v_mps) / 2 * depth;
    }
    return {sum.u_mps / (top_m - bottom_m), sum.v_mps / (top_m - bottom_m)};
}

Status check_reach(std::span<const WindAtHeight> winds, double most_gap_m) {
    if (winds.empty()) return fail(ErrorCode::not_found, "no layer has a wind");
    if (winds.front().height_m > tail_top_m)
        return fail(ErrorCode::not_found, "the lowest wind is {:.1f} km above the radar, not 0.5",
                    winds.front().height_m / 1000);
    if (winds.back().height_m < head_bottom_m)
        return fail(ErrorCode::not_found, "the highest wind is {:.1f} km above the radar, not 5.5",
                    winds.back().height_m / 1000);
    for (std::size_t i = 1; i < winds.size(); ++i) {
        if (winds[i].height_m - winds[i - 1].height_m <= most_gap_m ||
            winds[i - 1].height_m >= mean_top_m)
            continue;
        return fail(ErrorCode::not_found, "no wind from {:.1f} to {:.1f} km above the radar",
                    winds[i - 1].height_m / 1000, winds[i].height_m / 1000);
    }
    return {};
}

}  // namespace

Result<Motion> parse_motion(std::string_view text) {
    const auto numbers = parse_numbers(text, '/');
    if (!numbers || numbers->size() != 2 || (*numbers)[0] < 0 || (*numbers)[0] > 360 ||
        (*numbers)[1] < 0 || (*numbers)[1] > most_speed_mps) {
        return fail(ErrorCode::bad_argument,
                    "a motion is the direction that it comes from, in degrees, and the speed in "
                    "m/s, as in 240/15, not '{}'",
                    text);
    }
    const double toward = ((*numbers)[0] + 180) * degree, speed = (*numbers)[1];
    return Motion{speed * std::sin(toward), speed * std::cos(toward)};
}

std::string format_motion(const Motion& motion) {
    const double speed = std::round(motion.speed_mps() * 10) / 10;
    return fmt::format("{:.0f}/{:g}", std::fmod(std::round(motion.direction_deg()), 360.0), speed);
}

Result<StormMotions> bunkers_motions(std::span<const WindAtHeight> winds, double most_gap_m) {
    if (Status reaches = check_reach(winds, most_gap_m); !reaches) return pass_on(reaches);
    const Motion tail = mean_wind(winds, 0, tail_top_m);
    const Motion head = mean_wind(winds, head_bottom_m, mean_top_m);
    const Motion shear{head.u_mps - tail.u_mps, head.v_mps - tail.v_mps};
    if (shear.speed_mps() < least_shear_mps)
        return fail(ErrorCode::not_found, "the wind does not change from 0 to 6 km");
    const double scale = deviation_mps / shear.speed_mps();
    const Motion to_the_right{shear.v_mps * scale, -shear.u_mps * scale};
    StormMotions motions;
    motions.mean = mean_wind(winds, 0, mean_top_m);
    motions.right = {motions.mean.u_mps + to_the_right.u_mps,
                     motions.mean.v_mps + to_the_right.v_mps};
    motions.left = {motions.mean.u_mps - to_the_right.u_mps,
                    motions.mean.v_mps - to_the_right.v_mps};
    return motions;
}

Result<StormMotions> bunkers_motions(std::span<const WindLayer> layers) {
    std::vector<WindAtHeight> winds;
    bool has_birds = false;
    for (const WindLayer& layer : layers) {
        if (!layer.wind) continue;
        if (layer.wind->birds == Birds::likely) {
            has_birds = true;
            continue;
        }
        winds.push_back({layer.middle_m(), layer.wind->motion});
    }
    if (winds.empty() && has_birds)
        return fail(ErrorCode::not_found, "all winds are likely those of birds");
    return bunkers_motions(winds, most_layer_gap_m);
}

double storm_relative_mps(double velocity_mps, double azimuth_deg, double elevation_deg,
                          const Motion& storm) {
    const double along =
        storm.u_mps * std::sin(azimuth_deg * degree) + storm.v_mps * std::cos(azimuth_deg * degree);
    return velocity_mps - along * std::cos(elevation_deg * degree);
}

}  // namespace stormcellar::retrieve
