#include "slow_ray.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/grid/quad.h"

namespace stormcellar::grid::testing {
namespace {

constexpr double greatest_height_m = 1e6;
constexpr double least_height_m = -2e3;

class Walk {
  public:
    Walk(const RefractivityProfile& profile, const RayOptions& options)
        : profile_(profile), options_(options), height_(options.antenna_altitude_m) {
        const Quad elevation = Quad{options.elevation_deg} * acosq(-1) / 180;
        constant_ = n_r(height_, profile.layer_index(options.antenna_altitude_m)) * cosq(elevation);
        upwards_ = options.elevation_deg > 0;
        if (options.elevation_deg == 0) {  // upward, unless n r falls with height
            const std::size_t layer = profile.layer_index(options.antenna_altitude_m);
            upwards_ = n_r(height_ + Quad{1e-3}, layer) > n_r(height_, layer);
        }
    }

    // Goes to the height, or to the next turning point if that comes first. Returns true at the
    // height and false at the turning point.
    bool go_towards(Quad goal);
    // Goes to the next turning point. Returns false if there is none.
    bool go_to_turn() { return !go_towards(upwards_ ? greatest_height_m : least_height_m); }
    [[nodiscard]] SlowRay here() const {
        return {static_cast<double>(range_), static_cast<double>(angle_ * options_.earth_radius_m)};
    }

  private:
    [[nodiscard]] Quad index(Quad height, std::size_t layer) const {
        const RefractivityLayer& air = profile_.layer(layer);
        const Quad above = height - air.from_m;
        const Quad n_units = air.rate_per_m == 0 ? air.n_units + air.gradient_per_m * above
                                                 : air.n_units * expq(air.rate_per_m * above);
        return 1 + n_units / 1000000;
    }
    [[nodiscard]] Quad n_r(Quad height, std::size_t layer) const {
        return index(height, layer) * (options_.earth_radius_m + height);
    }
    [[nodiscard]] bool find_turn(Quad from, Quad to, std::size_t layer, Quad& turn) const;
    void integrate(Quad from, Quad to, std::size_t layer);

    const RefractivityProfile& profile_;
    const RayOptions& options_;
    Quad constant_ = 0, height_ = 0, range_ = 0, angle_ = 0;
    bool upwards_ = true;
    bool just_turned_ = true;  // just turned or begun, so the ray may be level
};

// Finds the first height on the way from `from` to `to` where n r is below the constant.
bool Walk::find_turn(Quad from, Quad to, std::size_t layer, Quad& turn) const {
    constexpr int pieces = 100;
    Quad good = from;
    for (int i = just_turned_ && height_ == from ? 2 : 1; i <= pieces; ++i) {
        const Quad share = Quad(i) / pieces;
        Quad bad = from + (to - from) * share * share * share;
        if (n_r(bad, layer) >= constant_) {
            good = bad;
            continue;
        }
        for (int step = 0; step < 120; ++step) {
            const Quad middle = (good + bad) / 2;
            (n_r(middle, layer) >= constant_ ? good : bad) = middle;
        }
        turn = good;
        return true;
    }
    return false;
}

// Uses the tanh-sinh rule, whose nodes are dense at the ends. There the integrand may grow like 1 /
// sqrt of the distance from the end.
void Walk::integrate(Quad from, Quad to, std::size_t layer) {
    constexpr int halves = 64;
    const Quad spacing = Quad{1} / 16;
    const Quad half_pi = acosq(-1) / 2;
    const Quad length = to - from;
    for (int i = -halves; i <= halves; ++i) {
        const Quad t = spacing * i;
        const Quad u = half_pi * sinhq(t);
        const Quad near_from = 1 / (1 + expq(-2 * u));  // share of the way, accurate near both ends
        const Quad near_to = 1 / (1 + expq(2 * u));
        const Quad height = i < 0 ? from + length * near_from : to - length * near_to;
        const Quad weight = spacing * half_pi * coshq(t) * 2 * near_from * near_to *
                            (length < 0 ? -length : length);
        const Quad n = index(height, layer);
        const Quad from_centre = options_.earth_radius_m + height;
        const Quad square = (n * from_centre - constant_) * (n * from_centre + constant_);
        if (!(square > 0)) continue;
        const Quad root = sqrtq(square);
        const Quad path = weight * n * from_centre / root;
        range_ += options_.range_kind == RangeKind::optical ? path * n : path;
        angle_ += weight * constant_ / (from_centre * root);
    }
}

bool Walk::go_towards(Quad goal) {
    std::size_t layer = profile_.layer_index(static_cast<double>(height_));
    if (!upwards_ && layer > 0 && height_ == Quad{profile_.layer(layer - 1).top_m}) --layer;
    while (height_ != goal) {
        const double bottom = layer == 0 ? least_height_m : profile_.layer(layer - 1).top_m;
        Quad end = upwards_ ? std::min(goal, Quad{profile_.layer(layer).top_m})
                            : std::max(goal, Quad{bottom});
        Quad turn = 0;
        const bool turns = find_turn(height_, end, layer, turn);
        if (turns) end = turn;
        for (Quad from = height_; from != end;) {  // in pieces in which N changes little
            Quad to = upwards_ ? std::min(end, from + 30000) : std::max(end, from - 30000);
            integrate(from, to, layer);
            from = to;
        }
        height_ = end;
        just_turned_ = turns;
        if (turns) {
            upwards_ = !upwards_;
            return false;
        }
        if (upwards_) {
            ++layer;
        } else if (layer > 0) {
            --layer;
        } else if (height_ != goal) {
            return true;
        }
    }
    return true;
}

}  // namespace

SlowRay slow_ray(const RefractivityProfile& profile, const RayOptions& options, int turns,
                 double height_m) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    Walk walk(profile, options);
    for (int i = 0; i < turns; ++i) {
        if (!walk.go_to_turn()) return {nan, nan};
    }
    if (!walk.go_towards(height_m)) return {nan, nan};
    return walk.here();
}

}  // namespace stormcellar::grid::testing
