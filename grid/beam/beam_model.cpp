#include "stormcellar/grid/beam_model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/degree.h"

namespace stormcellar::grid {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double close_enough_m = 1e-3;
constexpr int most_steps = 100;
constexpr double raise_deg = 0.1;

}  // namespace

EarthPoint BeamPath::at(double range_m) const noexcept {
    switch (kind_) {
        case BeamKind::flat_earth:
            return {range_m * cosine_, altitude_m_ + range_m * sine_};
        case BeamKind::four_thirds:
            return four_thirds_.forward({range_m, elevation_deg_});
        case BeamKind::traced:
            break;
    }
    return ray_->at(range_m);
}

BeamGeometry::BeamPoint BeamPath::over(double arc_m) const noexcept {
    // The usual beam comes first, because the code that fills an ArcTable calls over() often.
    if (kind_ == BeamKind::four_thirds) return four_thirds_.over(arc_m, elevation_deg_);
    if (kind_ == BeamKind::traced) return ray_->over(arc_m);
    if (!(cosine_ > 0)) return {nan, nan};
    return {arc_m / cosine_, altitude_m_ + arc_m * sine_ / cosine_};
}

BeamModel::BeamModel(BeamKind kind, double site_latitude_deg, double antenna_altitude_m)
    : kind_(kind),
      radius_m_(gaussian_radius_m(site_latitude_deg)),
      altitude_m_(antenna_altitude_m),
      four_thirds_(site_latitude_deg, antenna_altitude_m) {}

BeamModel BeamModel::flat_earth(double antenna_altitude_m) {
    return {BeamKind::flat_earth, 0, antenna_altitude_m};
}

BeamModel BeamModel::four_thirds(double site_latitude_deg, double antenna_altitude_m) {
    return {BeamKind::four_thirds, site_latitude_deg, antenna_altitude_m};
}

BeamModel BeamModel::traced(double site_latitude_deg, double antenna_altitude_m,
                            RefractivityProfile profile, RangeKind range_kind) {
    BeamModel model(BeamKind::traced, site_latitude_deg, antenna_altitude_m);
    model.profile_ = std::move(profile);
    model.range_kind_ = range_kind;
    return model;
}

std::string BeamModel::name() const {
    if (kind_ == BeamKind::flat_earth) return "flat earth";
    if (kind_ == BeamKind::four_thirds) return "4/3 earth";
    const char* const range = range_kind_ == RangeKind::geometric ? ", geometric range" : "";
    return "traced, " + profile_->name() + range;
}

TracedRay BeamModel::ray(double elevation_deg, double farthest_range_m) const {
    RayOptions options;
    options.earth_radius_m = radius_m_;
    options.antenna_altitude_m = altitude_m_;
    options.elevation_deg = elevation_deg;
    options.behind_m = behind_m;
    options.farthest_m = farthest_range_m;
    options.range_kind = range_kind_;
    return {*profile_, options};
}

BeamPath BeamModel::path(double elevation_deg) const {
    BeamPath path;
    path.kind_ = kind_;
    path.elevation_deg_ = elevation_deg;
    path.altitude_m_ = altitude_m_;
    if (kind_ == BeamKind::flat_earth) {
        path.cosine_ = std::cos(elevation_deg * degree);
        path.sine_ = std::sin(elevation_deg * degree);
    }
    path.four_thirds_ = four_thirds_;
    if (kind_ == BeamKind::traced) {
        path.ray_ = std::make_shared<const TracedRay>(ray(elevation_deg, farthest_m));
    }
    return path;
}

AntennaPoint BeamModel::inverse(EarthPoint point) const {
    const double above_antenna_m = point.height_m - altitude_m_;
    switch (kind_) {
        case BeamKind::flat_earth:
            return {std::hypot(point.arc_m, above_antenna_m),
                    std::atan2(above_antenna_m, point.arc_m) / degree};
        case BeamKind::four_thirds:
            return four_thirds_.inverse(point);
        case BeamKind::traced:
            break;
    }
    return traced_inverse(point);
}

// Iterates to the gate at which the traced beam meets the point. The inverse of the 4/3 earth turns
// the remaining error into the next step. A step that does not help is shortened, because the two
// models respond differently near ducts.
AntennaPoint BeamModel::traced_inverse(EarthPoint point) const {
    if (!std::isfinite(point.arc_m) || !std::isfinite(point.height_m)) return {nan, nan};
    const AntennaPoint target = four_thirds_.inverse(point);
    AntennaPoint best = target;
    AntennaPoint step;
    double least_m = std::numeric_limits<double>::infinity();
    double share = 1;
    for (int i = 0; i < most_steps && share > 1e-6; ++i) {
        const AntennaPoint gate = {best.range_m + share * step.range_m,
                                   best.elevation_deg + share * step.elevation_deg};
        const EarthPoint there =
            gate.range_m <= farthest_m
                ? ray(gate.elevation_deg, std::max(gate.range_m, 1.0)).at(gate.range_m)
                : EarthPoint{nan, nan};
        const double off_m = std::hypot(there.arc_m - point.arc_m, there.height_m - point.height_m);
        if (!std::isnan(off_m) && off_m < least_m) {
            const AntennaPoint reached = four_thirds_.inverse(there);
            best = gate;
            least_m = off_m;
            step = {target.range_m - reached.range_m, target.elevation_deg - reached.elevation_deg};
            if (off_m <= 1e-3 * close_enough_m) break;
            share = 1;
        } else if (std::isfinite(least_m)) {
            share /= 2;
        } else {
            // The traced beam met the ground before it reached the point.
            best.elevation_deg += raise_deg;
        }
    }
    if (!(least_m <= close_enough_m)) return {nan, nan};
    return best;
}

namespace {

constexpr double step_m = 500;

// Returns true if the place is within the limits. NaN is refused before it is compared, because a
// comparison with NaN may trap.
bool within(const BeamLimits& limits, double arc_m, double range_m, double height_m) {
    return !std::isnan(height_m) && arc_m <= limits.arc_m && range_m <= limits.range_m &&
           height_m >= limits.floor_m && height_m <= limits.ceiling_m;
}

// The difference between two models, at one arc or one range.
struct Sample {
    bool counts = false;  // true if the place by either model is within the limits
    BeamDifference difference;
};

void raise(BeamDifference& greatest, const BeamDifference& by, double if_missing) {
    const auto greater = [if_missing](double x, double y) {
        return std::max(x, std::isnan(y) ? if_missing : y);
    };
    greatest.height_m = greater(greatest.height_m, by.height_m);
    greatest.range_m = greater(greatest.range_m, by.range_m);
    greatest.gate_m = greater(greatest.gate_m, by.gate_m);
}

// Raises `greatest` to the differences at every step up to the limit, and at one step beyond the
// limit. A sample counts if it or one of its neighbors is within the limits. So the samples that
// count enclose everything within the limits.
template <class SampleAt>
void raise_along(BeamDifference& greatest, double limit_m, SampleAt sample_at) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Sample last;
    for (int i = 0; step_m * (i - 1) < limit_m; ++i) {
        const Sample now = sample_at(step_m * i);
        if (now.counts) raise(greatest, now.difference, infinity);
        if (now.counts != last.counts) raise(greatest, (now.counts ? last : now).difference, 0);
        last = now;
    }
}

}  // namespace

BeamDifference greatest_difference(const BeamModel& a, const BeamModel& b,
                                   std::span<const double> elevations_deg,
                                   const BeamLimits& limits) {
    BeamDifference greatest;
    for (const double elevation_deg : elevations_deg) {
        const BeamPath path_a = a.path(elevation_deg);
        const BeamPath path_b = b.path(elevation_deg);
        raise_along(greatest, limits.arc_m, [&](double arc_m) {
            const auto in_a = path_a.over(arc_m);
            const auto in_b = path_b.over(arc_m);
            return Sample{within(limits, arc_m, in_a.range_m, in_a.height_m) ||
                              within(limits, arc_m, in_b.range_m, in_b.height_m),
                          {std::abs(in_a.height_m - in_b.height_m),
                           std::abs(in_a.range_m - in_b.range_m), 0}};
        });
        raise_along(greatest, limits.range_m, [&](double range_m) {
            const EarthPoint in_a = path_a.at(range_m);
            const EarthPoint in_b = path_b.at(range_m);
            return Sample{
                within(limits, in_a.arc_m, range_m, in_a.height_m) ||
                    within(limits, in_b.arc_m, range_m, in_b.height_m),
                {0, 0, std::hypot(in_a.arc_m - in_b.arc_m, in_a.height_m - in_b.height_m)}};
        });
    }
    return greatest;
}

}  // namespace stormcellar::grid
