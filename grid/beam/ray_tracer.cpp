#include "stormcellar/grid/ray_tracer.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <utility>

#include "base/floating_point.h"

namespace stormcellar::grid {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double longest_step_m = 2000;
// A step climbs at most this share of a layer's scale height.
constexpr double share_of_scale = 0.25;
constexpr double shortest_step_m = 0.01;
constexpr std::size_t many_steps = 20'000;
constexpr double shortest_step_after_many_m = 100;

struct State {
    double height_m = 0;
    double sine = 0;  // sine of the elevation
    double arc_m = 0;
};

State operator+(State a, State b) {
    return {a.height_m + b.height_m, a.sine + b.sine, a.arc_m + b.arc_m};
}
State operator*(double factor, State a) {
    return {factor * a.height_m, factor * a.sine, factor * a.arc_m};
}

// Traces one ray from the antenna to the farthest range or to the floor.
class Tracer {
  public:
    Tracer(const RefractivityProfile& profile, double radius_m, RangeKind kind, double floor_m)
        : profile_(profile), radius_m_(radius_m), kind_(kind), floor_m_(floor_m) {}

    // Appends a node for the start and one for each step. Returns true if the ray ended at the
    // floor.
    bool run(State start, double farthest_m, std::vector<RayNode>& nodes);

  private:
    // The reason why a step ends.
    enum class Event { none, border, floor };
    struct Step {
        State state;
        double length_m = 0;
        Event event = Event::none;
    };

    [[nodiscard]] State rate(const State& state) const;
    [[nodiscard]] State advanced(const State& state, double length_m) const;
    [[nodiscard]] double suitable_length_m(const State& state) const;
    [[nodiscard]] Step step(const State& state, double rest_m, double shortest_m) const;
    template <class Value>
    [[nodiscard]] double where_zero(const State& state, double length_m, double guess_m,
                                    bool rising, Value value) const;
    [[nodiscard]] double parabola_m(const State& state, double rise_m) const;
    [[nodiscard]] RayNode node(double range_m, const State& state) const;

    const RefractivityProfile& profile_;
    double radius_m_;
    RangeKind kind_;
    double floor_m_;
    RefractivityLayer layer_;  // the layer that the ray is in
    double layer_bottom_m_ = 0;
};

// Applies Bouguer's law: d(sine) = cos^2 (1 / r + n' / n) ds. The state holds the sine of the
// elevation instead of the elevation, so that no sine must be computed.
State Tracer::rate(const State& state) const {
    const auto air = layer_.at(state.height_m);
    const double n = 1 + 1e-6 * air.n_units;
    const double cosine2 = std::max(0.0, (1 - state.sine) * (1 + state.sine));
    const double from_centre_m = radius_m_ + state.height_m;
    const double path = kind_ == RangeKind::optical ? 1 / n : 1;
    return {path * state.sine, path * cosine2 * (1 / from_centre_m + 1e-6 * air.gradient_per_m / n),
            path * std::sqrt(cosine2) * radius_m_ / from_centre_m};
}

State Tracer::advanced(const State& state, double length_m) const {
    const State k1 = rate(state);
    const State k2 = rate(state + length_m / 2 * k1);
    const State k3 = rate(state + length_m / 2 * k2);
    const State k4 = rate(state + length_m * k3);
    return state + length_m / 6 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
}

double Tracer::suitable_length_m(const State& state) const {
    const double rate_per_m = std::abs(layer_.rate_per_m) * (std::abs(state.sine) + 1e-3);
    return std::min(longest_step_m, share_of_scale / std::max(rate_per_m, 1e-9));
}

// Returns the length of a step from `state` at which value(state, rate) is zero. The value must be
// monotonic, with one zero up to length_m. Newton's method starts from guess_m. If the method
// leaves the bracket around the zero, the bracket is halved instead.
template <class Value>
double Tracer::where_zero(const State& state, double length_m, double guess_m, bool rising,
                          Value value) const {
    double low = 0;
    double high = length_m;
    double length = guess_m > low && guess_m < high ? guess_m : length_m / 2;
    for (int i = 0; i < 60 && high - low > 1e-9; ++i) {
        const State there = advanced(state, length);
        const auto [distance, slope] = value(there, rate(there));
        if (distance == 0) return length;
        ((distance > 0) == rising ? high : low) = length;
        const double next = slope == 0 ? low : length - distance / slope;
        // The error of Newton's method squares with each step, so the next error is negligible.
        if (std::abs(next - length) < 1e-6) return std::clamp(next, 0.0, length_m);
        length = next > low && next < high ? next : (low + high) / 2;
    }
    return length;
}

// Returns the length over which a ray of constant curvature rises by `rise_m` for the first time.
double Tracer::parabola_m(const State& state, double rise_m) const {
    const State rates = rate(state);
    const double root = rates.height_m * rates.height_m + 2 * rates.sine * rise_m;
    if (!(root >= 0)) return 0;
    const double divisor = rates.height_m + std::copysign(std::sqrt(root), rise_m);
    return divisor == 0 ? 0 : 2 * rise_m / divisor;
}

Tracer::Step Tracer::step(const State& state, double rest_m, double shortest_m) const {
    double length_m = std::min(suitable_length_m(state), rest_m);
    State next = advanced(state, length_m);

    // End the step at a turning point, so that the ray only rises or only falls within a step.
    if ((state.sine < 0 && next.sine > 0) || (state.sine > 0 && next.sine < 0)) {
        const double guess_m = length_m * state.sine / (state.sine - next.sine);
        const double turn_m = where_zero(
            state, length_m, guess_m, next.sine > 0,
            [](const State& s, const State& rates) { return std::pair(s.sine, rates.sine); });
        if (turn_m >= shortest_m) {
            length_m = turn_m;
            next = advanced(state, length_m);
            next.sine = 0;
        }
    }

    // Also end the step at the border of the layer, where dN/dh jumps, and at the floor of the
    // trace.
    const double bottom_m = std::max(layer_bottom_m_, floor_m_);
    if (next.height_m <= layer_.top_m && next.height_m >= bottom_m) {
        return {next, length_m, Event::none};
    }
    const double border_m = next.height_m > layer_.top_m ? layer_.top_m : bottom_m;
    length_m = where_zero(state, length_m, parabola_m(state, border_m - state.height_m),
                          next.height_m > border_m, [border_m](const State& s, const State& rates) {
                              return std::pair(s.height_m - border_m, rates.height_m);
                          });
    const Event event = border_m == floor_m_ ? Event::floor : Event::border;
    if (length_m < shortest_m && event == Event::border) {
        length_m = std::min(shortest_m, rest_m);
        return {advanced(state, length_m), length_m, event};
    }
    next = advanced(state, length_m);
    next.height_m = border_m;
    return {next, length_m, event};
}

RayNode Tracer::node(double range_m, const State& state) const {
    const State rates = rate(state);
    return {range_m, state.height_m, state.arc_m, rates.height_m, rates.arc_m};
}

bool Tracer::run(State state, double farthest_m, std::vector<RayNode>& nodes) {
    const auto enter = [&](std::size_t index) {
        layer_ = profile_.layer(index);
        layer_bottom_m_ = index == 0 ? -infinity : profile_.layer(index - 1).top_m;
    };
    enter(profile_.layer_index(state.height_m));
    nodes.push_back(node(0, state));
    double range_m = 0;
    for (std::size_t count = 0; range_m < farthest_m; ++count) {
        const double shortest_m = count < many_steps ? shortest_step_m : shortest_step_after_many_m;
        const Step next = step(state, farthest_m - range_m, shortest_m);
        range_m = next.length_m >= farthest_m - range_m ? farthest_m : range_m + next.length_m;
        state = next.state;
        if (range_m > nodes.back().range_m) nodes.push_back(node(range_m, state));
        if (next.event == Event::floor) return true;
        if (next.event == Event::border) {
            // At a border, the direction of the ray determines the next layer; elsewhere, its
            // height does.
            std::size_t index = profile_.layer_index(state.height_m);
            const bool at_bottom = index > 0 && state.height_m == profile_.layer(index - 1).top_m;
            if (at_bottom && state.sine < 0) --index;
            enter(index);
        }
    }
    return false;
}

// Returns the value at the share t of the way on the cubic through two values with given slopes.
double hermite(double t, double length, double from, double from_slope, double to,
               double to_slope) {
    const double rise = to - from;
    const double a = length * from_slope - rise;
    const double b = rise - length * to_slope;
    return from + t * (rise + (1 - t) * (a * (1 - t) + b * t));
}

// Returns the index of the last node at or before x. x must be between the first and the last node.
template <class Key>
std::size_t stretch(const std::vector<RayNode>& nodes, double x, Key key) {
    const auto after =
        std::upper_bound(nodes.begin() + 1, nodes.end() - 1, x,
                         [key](double value, const RayNode& node) { return value < node.*key; });
    return static_cast<std::size_t>(after - nodes.begin()) - 1;
}

}  // namespace

TracedRay::TracedRay(const RefractivityProfile& profile, const RayOptions& options) {
    const double altitude_m = options.antenna_altitude_m;
    if (!is_within(options.elevation_deg, -90.0, 90.0) || !std::isfinite(altitude_m) ||
        !std::isfinite(options.earth_radius_m) || !(options.earth_radius_m + altitude_m > 0) ||
        !std::isfinite(options.farthest_m) || !std::isfinite(options.behind_m)) {
        return;
    }
    const double sine = std::sin(options.elevation_deg * std::numbers::pi / 180);
    if (options.behind_m > 0) {
        Tracer back(profile, options.earth_radius_m, options.range_kind, -infinity);
        back.run({altitude_m, -sine, 0}, options.behind_m, nodes_);
        std::reverse(nodes_.begin(), nodes_.end());
        nodes_.pop_back();  // drop the antenna, which ends one trace and begins the other
        for (RayNode& node : nodes_) {
            node.range_m = -node.range_m;
            node.arc_m = -node.arc_m;
            node.height_rate = -node.height_rate;
        }
    }
    Tracer ahead(profile, options.earth_radius_m, options.range_kind,
                 std::min(options.floor_m, altitude_m));
    meets_floor_ = ahead.run({altitude_m, sine, 0}, options.farthest_m, nodes_);
}

EarthPoint TracedRay::at(double range_m) const noexcept {
    if (nodes_.size() < 2 || !is_within(range_m, nodes_.front().range_m, nodes_.back().range_m)) {
        return {nan, nan};
    }
    const std::size_t i = stretch(nodes_, range_m, &RayNode::range_m);
    const RayNode& a = nodes_[i];
    const RayNode& b = nodes_[i + 1];
    const double length = b.range_m - a.range_m;
    const double t = (range_m - a.range_m) / length;
    return {hermite(t, length, a.arc_m, a.arc_rate, b.arc_m, b.arc_rate),
            hermite(t, length, a.height_m, a.height_rate, b.height_m, b.height_rate)};
}

BeamGeometry::BeamPoint TracedRay::over(double arc_m) const noexcept {
    if (nodes_.size() < 2 || !is_within(arc_m, nodes_.front().arc_m, nodes_.back().arc_m)) {
        return {nan, nan};
    }
    const std::size_t i = stretch(nodes_, arc_m, &RayNode::arc_m);
    const RayNode& a = nodes_[i];
    const RayNode& b = nodes_[i + 1];
    const double length = b.arc_m - a.arc_m;
    if (!(length > 0 && a.arc_rate > 0 && b.arc_rate > 0)) return {nan, nan};
    const double t = (arc_m - a.arc_m) / length;
    return {hermite(t, length, a.range_m, 1 / a.arc_rate, b.range_m, 1 / b.arc_rate),
            hermite(t, length, a.height_m, a.height_rate / a.arc_rate, b.height_m,
                    b.height_rate / b.arc_rate)};
}

}  // namespace stormcellar::grid
