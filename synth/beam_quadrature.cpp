#include "synth/beam_quadrature.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/degree.h"

namespace stormcellar::synth {
namespace {

constexpr double nepers_a_db = std::numbers::ln10 / 10;
constexpr double reach_deviations = 4;
constexpr double least_points = 0.75;
constexpr double most_points = 4.2;  // the largest result is 0.75 * 2^2.5
constexpr double steps_apart = 1.7;  // in deviations of the integrand

// dBZ = peak - drop (x / length)^2 is a Gaussian in mm^6/m^3 with this deviation.
double deviation_m(double length_m, double drop_db) {
    return length_m / std::sqrt(2 * nepers_a_db * std::max(drop_db, 1.0));
}

// Returns the deviation of a Gaussian that is as narrow as the crests of a sine of this amplitude
// in decibels.
double wave_deviation_m(double most_db, double length_m) {
    if (most_db <= 0) return std::numeric_limits<double>::infinity();
    return length_m / (2 * std::numbers::pi * std::sqrt(std::max(1.0, nepers_a_db * most_db)));
}

void shrink(FinestLengths& lengths, double across_m, double up_m) {
    lengths.across_m = std::min(lengths.across_m, across_m);
    lengths.up_m = std::min(lengths.up_m, up_m);
}

// Returns the deviation of a leaning Gaussian along the vertical.
double leaning_m(double across_m, double up_m, double lean) {
    return 1 / std::hypot(1 / up_m, lean / across_m);
}

void add(FinestLengths& lengths, const Storm& storm) {
    const double narrow_m = std::min(storm.footprint.major_m, storm.footprint.minor_m);
    const double lean = std::hypot(storm.tilt_east, storm.tilt_north);
    const double drop_db = storm.peak_dbz - edge_dbz;
    double across_m = deviation_m(narrow_m, drop_db);
    double up_m = deviation_m(storm.top_m - storm.core_m, drop_db);
    if (storm.hook) {
        const double hook_drop_db = storm.hook->peak_dbz - edge_dbz;
        across_m = std::min(across_m, deviation_m(storm.hook->width_m, hook_drop_db));
        up_m = std::min(up_m, deviation_m(storm.hook->top_m, hook_drop_db));
    }
    across_m = std::min(across_m, wave_deviation_m(storm.ripple.most_db, storm.ripple.length_m));
    shrink(lengths, across_m, leaning_m(across_m, up_m, lean));
}

void add(FinestLengths& lengths, const Layer& layer) {
    const double narrow_m = std::min(layer.footprint.major_m, layer.footprint.minor_m);
    const double across_m = std::min(deviation_m(narrow_m, layer.peak_dbz - edge_dbz) / 2,
                                     wave_deviation_m(layer.ripple.most_db, layer.ripple.length_m));
    double up_m = layer.top_m - layer.base_m;
    lengths.cut_off = true;
    if (layer.bright_band_db > 0) {
        up_m = std::min(up_m, deviation_m(layer.bright_band_depth_m, layer.bright_band_db));
    }
    shrink(lengths, across_m, up_m);
}

void add(FinestLengths& lengths, const Box& box) {
    const double across_m = std::min(deviation_m(box.edge_m, box.peak_dbz - edge_dbz),
                                     wave_deviation_m(box.wave.most_db, box.wave.length_m));
    lengths.cut_off = true;
    shrink(lengths, across_m, box.top_m - box.base_m);
}

// Winds have kinks at the radius of a vortex and at levels. Kinks need closer points than
// Gaussians.
void add(FinestLengths& lengths, const Wind& wind) {
    constexpr double part = 0.1;
    for (const Vortex& vortex : wind.vortices) {
        lengths.across_m = std::min(lengths.across_m, part * vortex.radius_m);
        if (std::isfinite(vortex.base_m) || std::isfinite(vortex.top_m)) lengths.cut_off = true;
    }
    for (std::size_t i = 1; i < wind.levels.size(); ++i) {
        const double step_m = wind.levels[i].height_m - wind.levels[i - 1].height_m;
        lengths.up_m = std::min(lengths.up_m, part * std::max(step_m, 1.0));
    }
}

void normalize(std::vector<BeamNode>& nodes) {
    double sum = 0;
    for (const BeamNode& node : nodes) {
        sum += node.weight;
    }
    for (BeamNode& node : nodes) {
        node.weight /= sum;
    }
}

// Returns points that are equally spaced, out to `reach` on both sides, with the weight of each.
template <typename Weight>
std::vector<BeamNode> equal_steps(double step, double reach, Weight weight_at) {
    const auto side = static_cast<int>(std::floor(reach / step + 1e-9));
    std::vector<BeamNode> nodes;
    for (int i = -side; i <= side; ++i) {
        nodes.push_back({i * step, weight_at(i * step)});
    }
    normalize(nodes);
    return nodes;
}

}  // namespace

FinestLengths finest_lengths(const Weather& weather) {
    constexpr double infinite = std::numeric_limits<double>::infinity();
    FinestLengths lengths{infinite, infinite, false};
    for (const Storm& storm : weather.storms) {
        add(lengths, storm);
    }
    for (const Layer& layer : weather.layers) {
        add(lengths, layer);
    }
    for (const Box& box : weather.boxes) {
        add(lengths, box);
    }
    if (weather.wind) add(lengths, *weather.wind);
    return lengths;
}

double pattern_deviation_deg(double beam_width_deg) {
    return beam_width_deg / (4 * std::sqrt(std::numbers::ln2));
}

std::vector<BeamNode> elevation_nodes(double beam_width_deg, double per_deviation) {
    if (beam_width_deg <= 0) return {{0, 1}};
    const double deviation_deg = pattern_deviation_deg(beam_width_deg);
    return equal_steps(deviation_deg / per_deviation, reach_deviations * deviation_deg,
                       [deviation_deg](double offset_deg) {
                           const double x = offset_deg / deviation_deg;
                           return std::exp(-x * x / 2);
                       });
}

std::vector<BeamNode> azimuth_nodes(double beam_width_deg, double elevation_deg, double turn_deg,
                                    double per_deviation) {
    if (beam_width_deg <= 0) return {{0, 1}};
    const double deviation_deg =
        pattern_deviation_deg(beam_width_deg) / std::cos(elevation_deg * degree);
    const double scale_deg = std::numbers::sqrt2 * deviation_deg;
    return equal_steps(deviation_deg / per_deviation,
                       reach_deviations * deviation_deg + turn_deg / 2,
                       [scale_deg, turn_deg](double offset_deg) {
                           return std::erf((offset_deg + turn_deg / 2) / scale_deg) -
                                  std::erf((offset_deg - turn_deg / 2) / scale_deg);
                       });
}

std::vector<BeamNode> range_nodes(double pulse_length_m) {
    if (pulse_length_m <= 0) return {{0, 1}};
    const double deviation_m = 0.35 * pulse_length_m / 2;
    const double off_m = std::numbers::sqrt3 * deviation_m;
    return {{-off_m, 1.0 / 6}, {0, 2.0 / 3}, {off_m, 1.0 / 6}};
}

std::vector<Weather> single_features(const Weather& weather) {
    std::vector<Weather> singles;
    for (const Storm& storm : weather.storms) {
        singles.push_back({{storm}, {}, {}, weather.wind});
    }
    for (const Layer& layer : weather.layers) {
        singles.push_back({{}, {layer}, {}, weather.wind});
    }
    for (const Box& box : weather.boxes) {
        singles.push_back({{}, {}, {box}, weather.wind});
    }
    return singles;
}

double points_a_deviation(double beam_width_deg, double range_m, double finest_m) {
    const double deviation_m = pattern_deviation_deg(beam_width_deg) * degree * range_m;
    const double needed = std::hypot(1.0, deviation_m / finest_m) / steps_apart;
    double points = least_points;
    while (points < needed && points < most_points) {
        points *= std::numbers::sqrt2;
    }
    return points;
}

}  // namespace stormcellar::synth
