#include "retrieve/cyclone/center_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <utility>

#include "retrieve/cyclone/nelder_mead.h"

namespace stormcellar::retrieve {
namespace {

constexpr double most_uniform_mps = 30;
constexpr double grid_step_m = 6000;
constexpr std::array<double, 7> guess_radii_m{10e3, 14e3, 20e3, 28e3, 40e3, 56e3, 80e3};
constexpr int guess_samples = 24, guess_waves = 2;
constexpr double widest_guess_gap_deg = 60;
constexpr double least_search_radius_m = 5000;
constexpr double wide_part = 1.4;
constexpr int most_rounds = 10;
constexpr double nowhere = -std::numeric_limits<double>::infinity();

using CirclesAtGuess = std::array<std::optional<RingFit>, guess_radii_m.size()>;

CirclesAtGuess circles_at(const PolarVelocity& field, double rotation, grid::PlanePoint center) {
    CirclesAtGuess circles;
    for (std::size_t i = 0; i < circles.size(); ++i) {
        RingRequest request;
        request.center = center;
        request.radius_m = guess_radii_m[i];
        request.samples = guess_samples;
        request.most_waves = guess_waves;
        request.rotation = rotation;
        circles[i] = fit_ring(field, request);
        if (circles[i] && circles[i]->largest_gap_deg > widest_guess_gap_deg) circles[i].reset();
    }
    return circles;
}

// Radii of the circles whose tangential wind is greatest about the right center, as multiples of
// the radius of maximum wind. With smaller circles, an asymmetry would move the center.
constexpr std::array<double, 5> annulus{1, 1.015, 1.03, 1.045, 1.06};
// The radii for which a center is sought, as multiples of the radius of maximum wind found so far.
// A wrong center and a wrong radius can agree with each other, but not with the greatest wind.
constexpr std::array<double, 4> radius_parts{0.88, 0.94, 1, 1.06};
constexpr double first_step_m = 2000, last_step_m = 50;  // of the simplex

// Returns the number of points for a circle, about 1.5 km apart, so that noise averages out.
int samples_of(double radius_m) {
    return std::clamp(static_cast<int>(2 * std::numbers::pi * radius_m / 1500), 48, 180);
}

// Returns the mean tangential wind of circles, times the distance from the radar. The velocities
// show the product: a center that is too near to the radar by 2 % gives winds that are 2 % too
// strong, so the wind alone would draw the center toward the radar.
double moment_of(const PolarVelocity& field, double rotation, double radius_m,
                 std::span<const double> parts, grid::PlanePoint center) {
    double sum = 0;
    for (const double part : parts) {
        RingRequest request;
        request.center = center;
        request.radius_m = radius_m * part;
        request.samples = samples_of(request.radius_m);
        request.most_waves = 2;
        request.rotation = rotation;
        const auto fit = fit_ring(field, request);
        if (!fit) return nowhere;
        sum += fit->tangential_mps;
    }
    return sum / static_cast<double>(parts.size()) * std::hypot(center.x_m, center.y_m);
}

PlaneMaximum climb_for(const PolarVelocity& field, double rotation, double radius_m,
                       std::span<const double> parts, grid::PlanePoint start) {
    return climb(start, first_step_m, last_step_m, [&](grid::PlanePoint place) {
        return moment_of(field, rotation, radius_m, parts, place);
    });
}

double strongest_moment(const VortexProfile& profile) {
    return profile.strongest().fit.tangential_mps *
           std::hypot(profile.center.x_m, profile.center.y_m);
}

// Returns the mean excess of the strongest ring and of the ring at 1.4 times its radius, or of the
// outermost ring. A cyclone is wide, so both rings must show it.
double excess_of(const VortexProfile& profile) {
    const double distance = std::hypot(profile.center.x_m, profile.center.y_m);
    const ProfileRing& top = profile.strongest();
    auto outer = std::ranges::lower_bound(profile.rings, wide_part * top.radius_m, {},
                                          &ProfileRing::radius_m);
    if (outer == profile.rings.end()) --outer;
    return (vortex_excess_mps(top.fit, top.radius_m / distance) +
            vortex_excess_mps(outer->fit, outer->radius_m / distance)) /
           2;
}

// Returns the profile about the best of the centers that are found for several radii.
VortexProfile improve(const PolarVelocity& field, double rotation, const VortexProfile& profile) {
    VortexProfile best;
    for (const double part : radius_parts) {
        const double radius = std::max(part * profile.strongest().radius_m, least_search_radius_m);
        const PlaneMaximum top = climb_for(field, rotation, radius, annulus, profile.center);
        if (top.value == nowhere) continue;
        VortexProfile candidate = fit_profile(field, top.place, radius, rotation);
        if (candidate.rings.empty()) continue;
        if (best.rings.empty() || strongest_moment(candidate) > strongest_moment(best))
            best = std::move(candidate);
    }
    return best;
}

struct Scatter {
    grid::PlanePoint mean;
    double size_m = 0;
};

// Climbs from eight places around the center, and takes the mean of the places that the best climbs
// reach. Then climbs from this mean for each single circle. The scatter is the root mean square
// distance of all these places from the mean; most of it comes from the single circles.
Scatter scatter_of(const PolarVelocity& field, double rotation, const VortexProfile& profile) {
    const double radius = std::max(profile.strongest().radius_m, least_search_radius_m);
    const grid::PlanePoint center = profile.center;
    std::array<PlaneMaximum, 8> ends;
    for (std::size_t i = 0; i < ends.size(); ++i) {
        const double angle = 2 * std::numbers::pi * static_cast<double>(i) / ends.size();
        ends[i] =
            climb_for(field, rotation, radius, annulus,
                      {center.x_m + 4000 * std::cos(angle), center.y_m + 4000 * std::sin(angle)});
    }
    const double best = std::ranges::max_element(ends, {}, &PlaneMaximum::value)->value;
    std::vector<grid::PlanePoint> tops;
    for (const PlaneMaximum& end : ends)
        if (end.value > 0.998 * best) tops.push_back(end.place);
    if (tops.empty()) tops.push_back(center);
    Scatter scatter;
    for (const grid::PlanePoint& top : tops) {
        scatter.mean.x_m += top.x_m / static_cast<double>(tops.size());
        scatter.mean.y_m += top.y_m / static_cast<double>(tops.size());
    }
    for (const double part : annulus)
        tops.push_back(climb_for(field, rotation, radius, {&part, 1}, scatter.mean).place);
    for (const grid::PlanePoint& top : tops)
        scatter.size_m +=
            std::pow(top.x_m - scatter.mean.x_m, 2) + std::pow(top.y_m - scatter.mean.y_m, 2);
    scatter.size_m = std::sqrt(scatter.size_m / static_cast<double>(tops.size()));
    return scatter;
}

}  // namespace

double vortex_excess_mps(const RingFit& fit, double radius_share) {
    return fit.tangential_mps - most_uniform_mps * radius_share - 2 * fit.residual_mps;
}

CenterGuesses guess_centers(const PolarVelocity& field, double rotation,
                            std::optional<grid::PlanePoint> near, double around_m) {
    const grid::PlanePoint middle = near.value_or(grid::PlanePoint{});
    const double reach = near ? around_m : field.reach_m();
    CenterGuesses guesses;
    std::array<CenterGuess, guess_radii_m.size()> best{};
    const int steps = static_cast<int>(reach / grid_step_m);
    for (int i = -steps; i <= steps; ++i) {
        for (int j = -steps; j <= steps; ++j) {
            const grid::PlanePoint center{middle.x_m + i * grid_step_m,
                                          middle.y_m + j * grid_step_m};
            const double distance = std::hypot(center.x_m, center.y_m);
            if (std::hypot(i, j) * grid_step_m > reach || distance > field.reach_m()) continue;
            const CirclesAtGuess circles = circles_at(field, rotation, center);
            // A cyclone is wide: two circles must show it.
            for (std::size_t k = 0; k + 1 < circles.size(); ++k) {
                if (!circles[k] || !circles[k + 1]) continue;
                guesses.has_circles = true;
                const double excess =
                    (vortex_excess_mps(*circles[k], guess_radii_m[k] / distance) +
                     vortex_excess_mps(*circles[k + 1], guess_radii_m[k + 1] / distance)) /
                    2;
                if (excess > best[k].excess_mps) best[k] = {center, guess_radii_m[k], excess};
            }
        }
    }
    for (const CenterGuess& guess : best)
        if (guess.excess_mps > 0) guesses.best.push_back(guess);
    return guesses;
}

std::optional<FoundCenter> refine_center(PolarVelocity& field, double rotation,
                                         const CenterGuess& guess) {
    FoundCenter found;
    found.profile = fit_profile(field, guess.center, guess.radius_m, rotation);
    for (int round = 0; round < most_rounds && !found.profile.rings.empty(); ++round) {
        field.refold([&](double x, double y) { return found.profile.velocity_at(x, y); });
        VortexProfile better = improve(field, rotation, found.profile);
        const double moved = std::hypot(better.center.x_m - found.profile.center.x_m,
                                        better.center.y_m - found.profile.center.y_m);
        found.profile = std::move(better);
        if (moved < 2 * last_step_m) break;
    }
    if (found.profile.rings.empty()) return std::nullopt;
    const Scatter scatter = scatter_of(field, rotation, found.profile);
    found.error_m = scatter.size_m;
    found.profile = fit_profile(field, scatter.mean, found.profile.strongest().radius_m, rotation);
    if (found.profile.rings.empty()) return std::nullopt;
    found.excess_mps = excess_of(found.profile);
    return found;
}

}  // namespace stormcellar::retrieve
