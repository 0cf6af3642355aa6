#include "stormcellar/retrieve/cyclone.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/degree.h"
#include "retrieve/cyclone/center_search.h"
#include "retrieve/cyclone/central_pressure.h"

namespace stormcellar::retrieve {
namespace {

constexpr double around_guess_m = 40'000;
constexpr double same_center_m = 20'000;
constexpr double least_hurricane_mps = 17.5;  // a tropical storm
constexpr double least_significance = 10;     // of the wind, in standard errors of its fit
constexpr double unknown_across_error_mps = 5, known_across_error_mps = 2;
constexpr double lowest_sweeps_deg = 0.3;  // sweeps this much above the lowest count as lowest

template <class... Args>
tl::unexpected<NoCyclone> refuse(NoCycloneReason reason, fmt::format_string<Args...> format,
                                 Args&&... args) {
    return tl::unexpected<NoCyclone>(
        NoCyclone{reason, fmt::format(format, std::forward<Args>(args)...)});
}

struct ChosenField {
    std::size_t sweep = 0;
    PolarVelocity field;
};

// Chooses the lowest sweep with velocities. Of several sweeps at about the same elevation, the
// sweep with the most velocities is chosen.
tl::expected<ChosenField, NoCyclone> choose_field(const level2::Volume& volume,
                                                  const Dealiased& folds) {
    if (folds.sweeps.empty())
        return refuse(NoCycloneReason::no_velocities, "the volume has no velocities");
    const auto elevation_of = [&](const SweepFolds& of) {
        return volume.sweeps[of.sweep].mean_elevation_deg();
    };
    std::vector<const SweepFolds*> usable;
    for (const SweepFolds& of : folds.sweeps) {
        const level2::Sweep& sweep = volume.sweeps[of.sweep];
        if (!usable_radials(sweep, sweep.moments[of.moment]).empty() &&
            std::isfinite(elevation_of(of)))
            usable.push_back(&of);
    }
    if (usable.empty()) {
        return refuse(NoCycloneReason::no_nyquist,
                      "the file does not give the Nyquist velocity, so the velocities may be "
                      "folded");
    }
    double lowest = elevation_of(*usable.front());
    for (const SweepFolds* of : usable)
        lowest = std::min(lowest, elevation_of(*of));
    std::optional<ChosenField> chosen;
    for (const SweepFolds* of : usable) {
        if (elevation_of(*of) > lowest + lowest_sweeps_deg) continue;
        PolarVelocity field(volume, *of);
        if (!chosen || field.values() > chosen->field.values())
            chosen = ChosenField{of->sweep, std::move(field)};
    }
    if (chosen->field.values() == 0)
        return refuse(NoCycloneReason::no_velocities, "the lowest sweep has no velocities");
    return std::move(*chosen);
}

struct Search {
    FoundCenter found;
    PolarVelocity field;  // refolded
};

// Refines the guesses, the most likely first, and returns the center with the greatest excess.
std::optional<Search> refine_best(const PolarVelocity& field, double rotation,
                                  std::vector<CenterGuess> guesses) {
    std::ranges::sort(guesses, std::ranges::greater{}, &CenterGuess::excess_mps);
    std::optional<Search> best;
    std::vector<grid::PlanePoint> centers;
    for (const CenterGuess& guess : guesses) {
        const bool is_known = std::ranges::any_of(centers, [&](grid::PlanePoint center) {
            return std::hypot(center.x_m - guess.center.x_m, center.y_m - guess.center.y_m) <
                   same_center_m;
        });
        if (is_known) continue;
        PolarVelocity refolded = field;
        auto found = refine_center(refolded, rotation, guess);
        if (!found) continue;
        centers.push_back(found->profile.center);
        if (best && best->found.excess_mps >= found->excess_mps) continue;
        best = Search{std::move(*found), std::move(refolded)};
    }
    return best;
}

// Returns the error of each ring's tangential wind that is due to the error of the center.
std::vector<double> errors_of_center(const Search& search, double rotation) {
    const VortexProfile& profile = search.found.profile;
    const double off = search.found.error_m;
    std::vector<double> errors(profile.rings.size());
    const std::array<grid::PlanePoint, 4> ways{{{off, 0}, {-off, 0}, {0, off}, {0, -off}}};
    for (const grid::PlanePoint way : ways) {
        for (std::size_t i = 0; i < profile.rings.size(); ++i) {
            RingRequest request;
            request.center = {profile.center.x_m + way.x_m, profile.center.y_m + way.y_m};
            request.radius_m = profile.rings[i].radius_m;
            request.rotation = rotation;
            if (const auto fit = fit_ring(search.field, request)) {
                const double change = fit->tangential_mps - profile.rings[i].fit.tangential_mps;
                errors[i] += change * change / static_cast<double>(ways.size());
            }
        }
    }
    for (double& error : errors)
        error = std::sqrt(error);
    return errors;
}

// Returns the error of a ring's tangential wind that is due to the width of beam and bins. Where
// the wind is greatest, neighboring rings are weaker on both sides, so the mean over the width is
// also weaker.
double error_of_width(const VortexProfile& profile, std::size_t ring) {
    if (ring == 0 || ring + 1 == profile.rings.size()) return 0;
    const auto wind = [&](std::size_t at) { return profile.rings[at].fit.tangential_mps; };
    return std::abs(wind(ring) - (wind(ring - 1) + wind(ring + 1)) / 2) / 2;
}

// Returns the component of a wind to the left of the beam through the center.
double across_of(HorizontalWind wind, grid::PlanePoint center) {
    return (wind.north_mps * center.x_m - wind.east_mps * center.y_m) /
           std::hypot(center.x_m, center.y_m);
}

// Averages the mean wind along the beam over the rings; its error is the scatter of the rings.
Estimate along_of(const VortexProfile& profile) {
    double weights = 0, sum = 0, squares = 0;
    for (const ProfileRing& ring : profile.rings) {
        const double error = std::max(ring.fit.along_error_mps, 0.1);
        weights += 1 / (error * error);
        sum += ring.fit.along_mps / (error * error);
        squares += ring.fit.along_mps * ring.fit.along_mps / (error * error);
    }
    const double mean = sum / weights;
    return {mean, std::sqrt(std::max(0.0, squares / weights - mean * mean))};
}

Cyclone describe(const Search& search, const CycloneOptions& options, double rotation) {
    const VortexProfile& profile = search.found.profile;
    Cyclone cyclone;
    cyclone.elevation_deg = search.field.elevation_deg();
    cyclone.center_plane = profile.center;
    cyclone.center_error_m = search.found.error_m;
    cyclone.distance_m = std::hypot(profile.center.x_m, profile.center.y_m);
    cyclone.height_m = search.field.height_m(cyclone.distance_m);
    cyclone.along_mps = along_of(profile);
    cyclone.across_mps = {0, unknown_across_error_mps};
    if (options.mean_wind)
        cyclone.across_mps = {across_of(*options.mean_wind, profile.center),
                              known_across_error_mps};
    const std::vector<double> by_center = errors_of_center(search, rotation);
    for (std::size_t i = 0; i < profile.rings.size(); ++i) {
        const auto& [radius, fit] = profile.rings[i];
        const double share = radius / cyclone.distance_m;
        CycloneRing& ring = cyclone.rings.emplace_back();
        ring.radius_m = radius;
        ring.across_error_mps = cyclone.across_mps.error * share;
        const double own_error =
            std::hypot(fit.tangential_error_mps, by_center[i], error_of_width(profile, i));
        ring.tangential_mps = {fit.tangential_mps + rotation * cyclone.across_mps.value * share,
                               std::hypot(own_error, ring.across_error_mps)};
        ring.radial_mps = {fit.radial_mps, fit.radial_error_mps};
        ring.wave1_mps = fit.wave1_mps;
        ring.waves = fit.waves;
        ring.coverage = fit.coverage;
        ring.largest_gap_deg = fit.largest_gap_deg;
    }
    cyclone.strongest = static_cast<std::size_t>(&profile.strongest() - profile.rings.data());
    return cyclone;
}

// Returns the reason why a vortex that was found is not a hurricane, or why its wind is not
// certain.
std::optional<NoCyclone> doubt(const Cyclone& cyclone, double excess_mps) {
    const CycloneRing& top = cyclone.maximum();
    const double fit_error = std::sqrt(
        std::max(0.0, std::pow(top.tangential_mps.error, 2) - std::pow(top.across_error_mps, 2)));
    const double wind = top.tangential_mps.value;
    if (wind < least_hurricane_mps || wind < least_significance * fit_error) {
        return NoCyclone{NoCycloneReason::no_vortex,
                         fmt::format("no hurricane: the strongest circulation has {:.0f} m/s with "
                                     "an error of {:.0f} m/s",
                                     wind, fit_error)};
    }
    if (!(excess_mps > 0)) {
        return NoCyclone{
            NoCycloneReason::no_vortex,
            fmt::format("no hurricane: a uniform wind could also show the strongest circulation, "
                        "{:.0f} m/s {:.0f} km from its center",
                        wind, top.radius_m / 1000)};
    }
    const double outer_m = cyclone.rings.back().radius_m;
    if (cyclone.rings.size() - cyclone.strongest <= 3) {
        if (outer_m > 0.8 * cyclone.distance_m) {
            return NoCyclone{
                NoCycloneReason::radar_inside,
                fmt::format("the wind still grows at {:.0f} km from the center, and the radar is "
                            "{:.0f} km from it",
                            outer_m / 1000, cyclone.distance_m / 1000)};
        }
        return NoCyclone{NoCycloneReason::no_maximum,
                         fmt::format("the wind still grows {:.0f} km from the center, where the "
                                     "velocities end",
                                     outer_m / 1000)};
    }
    return std::nullopt;
}

tl::expected<Search, NoCyclone> search_center(const PolarVelocity& field,
                                              const CycloneOptions& options,
                                              const grid::SiteFrame& site, double rotation) {
    const double reach_km = field.reach_m() / 1000;
    std::optional<grid::PlanePoint> near;
    if (options.near) {
        near = grid::SiteFrame::to_plane(site.to_polar(*options.near));
        const double distance = std::hypot(near->x_m, near->y_m);
        if (!(distance < field.reach_m())) {
            return refuse(NoCycloneReason::out_of_reach,
                          "the center is {:.0f} km from the radar, but velocities reach {:.0f} km",
                          distance / 1000, reach_km);
        }
    }
    const CenterGuesses guesses = guess_centers(field, rotation, near, around_guess_m);
    if (!guesses.has_circles) {
        return refuse(NoCycloneReason::too_few_velocities,
                      "too few velocities: no two circles within {:.0f} km are covered without "
                      "gaps of more than 60 degrees",
                      reach_km);
    }
    auto best = refine_best(field, rotation, guesses.best);
    if (!best) {
        return refuse(NoCycloneReason::no_vortex,
                      "no hurricane whose center is within {:.0f} km, as far as velocities reach",
                      reach_km);
    }
    return std::move(*best);
}

}  // namespace

tl::expected<Cyclone, NoCyclone> find_cyclone(const level2::Volume& volume, const Dealiased& folds,
                                              const CycloneOptions& options) {
    auto chosen = choose_field(volume, folds);
    if (!chosen) return tl::unexpected<NoCyclone>(chosen.error());
    const auto antenna = level2::antenna_position(volume);
    if (!antenna)
        return refuse(NoCycloneReason::no_position, "the position of the radar is unknown");
    const grid::SiteFrame site(antenna->latitude_deg, antenna->longitude_deg);
    const double rotation = antenna->latitude_deg < 0 ? -1 : 1;
    const auto search = search_center(chosen->field, options, site, rotation);
    if (!search) return tl::unexpected<NoCyclone>(search.error());

    Cyclone cyclone = describe(*search, options, rotation);
    if (auto reason = doubt(cyclone, search->found.excess_mps))
        return tl::unexpected<NoCyclone>(std::move(*reason));
    cyclone.sweep = chosen->sweep;
    cyclone.center = site.to_geo(
        grid::SiteFrame::from_plane(cyclone.center_plane.x_m, cyclone.center_plane.y_m));
    cyclone.refolded_share = static_cast<double>(search->field.differences(chosen->field)) /
                             static_cast<double>(chosen->field.values());
    cyclone.pressure_deficit_hpa = pressure_deficit_hpa(cyclone.rings, cyclone.center.latitude_deg,
                                                        antenna->altitude_m + cyclone.height_m);
    return cyclone;
}

}  // namespace stormcellar::retrieve
