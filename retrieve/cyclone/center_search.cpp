#include "retrieve/cyclone/center_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "retrieve/cyclone/nelder_mead.h"

namespace stormcellar::retrieve {
namespace {

constexpr double most_uniform_mps = 30;
constexpr double grid_step_m = 6000;
constexpr std::array<double, 7> guess_radii_m{10e3, 14e3, 20e3, 28e3, 40e3, 56e3, 80e3};
constexpr int guess_samples = 24, guess_waves = 2;
constexpr double widest_guess_gap_deg = 60;
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

// Returns the mean tangential wind of an annulus 4 km wide, times the distance from the radar. The
// velocities show the product: a wrong center, too near to the radar by 2 %, gives winds that are 2
// % too strong, so that the wind alone would draw the center toward the radar.
double annulus_moment(const PolarVelocity& field, double rotation, double radius_m,
                      grid::PlanePoint center) {
    double sum = 0;
    for (const double offset : {-2000.0, 0.0, 2000.0}) {
        RingRequest request;
        request.center = center;
        request.radius_m = radius_m + offset;
        request.samples = 48;
        request.most_waves = 2;
        request.rotation = rotation;
        const auto fit = fit_ring(field, request);
        if (!fit) return nowhere;
        sum += fit->tangential_mps;
    }
    return sum / 3 * std::hypot(center.x_m, center.y_m);
}

struct Climbed {
    grid::PlanePoint mean;
    double scatter_m = 0;
};

// Climbs from eight places around `center`, for circles of the radius and somewhat smaller and
// larger ones. Climbs that end well below the best of their radius do not count.
std::optional<Climbed> climb_from_around(const PolarVelocity& field, double rotation,
                                         double radius_m, grid::PlanePoint center) {
    std::vector<grid::PlanePoint> tops;
    for (const double factor : {0.9, 1.0, 1.1}) {
        const double radius = std::max(radius_m * factor, VortexProfile::least_radius_m + 2000);
        std::array<PlaneMaximum, 8> ends;
        for (std::size_t i = 0; i < ends.size(); ++i) {
            const double angle = 2 * std::numbers::pi * static_cast<double>(i) / ends.size();
            ends[i] =
                climb({center.x_m + 4000 * std::cos(angle), center.y_m + 4000 * std::sin(angle)},
                      2000, 50, [&](grid::PlanePoint place) {
                          return annulus_moment(field, rotation, radius, place);
                      });
        }
        const double best = std::ranges::max_element(ends, {}, &PlaneMaximum::value)->value;
        for (const PlaneMaximum& end : ends)
            if (end.value > 0.99 * best) tops.push_back(end.place);
    }
    if (tops.empty()) return std::nullopt;
    Climbed climbed;
    const auto count = static_cast<double>(tops.size());
    for (const grid::PlanePoint& top : tops) {
        climbed.mean.x_m += top.x_m / count;
        climbed.mean.y_m += top.y_m / count;
    }
    for (const grid::PlanePoint& top : tops)
        climbed.scatter_m +=
            (std::pow(top.x_m - climbed.mean.x_m, 2) + std::pow(top.y_m - climbed.mean.y_m, 2)) /
            count;
    climbed.scatter_m = std::sqrt(climbed.scatter_m);
    return climbed;
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
    for (int round = 0; round < 8; ++round) {
        if (found.profile.rings.empty()) return std::nullopt;
        field.refold([&](double x, double y) { return found.profile.velocity_at(x, y); });
        const double radius = found.profile.strongest().radius_m;
        const auto climbed = climb_from_around(field, rotation, radius, found.profile.center);
        if (!climbed) return std::nullopt;
        const double moved = std::hypot(climbed->mean.x_m - found.profile.center.x_m,
                                        climbed->mean.y_m - found.profile.center.y_m);
        found.error_m = climbed->scatter_m;
        found.profile = fit_profile(field, climbed->mean, radius, rotation);
        if (moved < 200) break;
    }
    if (found.profile.rings.empty()) return std::nullopt;
    const ProfileRing& top = found.profile.strongest();
    const grid::PlanePoint center = found.profile.center;
    found.excess_mps =
        vortex_excess_mps(top.fit, top.radius_m / std::hypot(center.x_m, center.y_m));
    return found;
}

}  // namespace stormcellar::retrieve
