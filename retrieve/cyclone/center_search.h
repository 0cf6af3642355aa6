// retrieve/cyclone/center_search.h -- finds the center of a cyclone as the place about which the
// tangential wind is greatest.
//
// Source    Lee and Marks (2000), simplex of a circle's mean tangential wind; Bell and Lee (2012),
//           scatter of its starts. The search of the whole plane is our own.
// Units     Meters in the plane about the site; m/s.
// Threads   Pure functions.
#pragma once

#include <optional>
#include <vector>

#include "retrieve/cyclone/vortex_profile.h"

namespace stormcellar::retrieve {

// Returns the tangential wind, less what may be due to a uniform wind of 30 m/s across the beam and
// to the scatter about the fitted wind.
[[nodiscard]] double vortex_excess_mps(const RingFit& fit, double radius_share);

struct CenterGuess {
    grid::PlanePoint center;
    double radius_m = 0;
    double excess_mps = 0;  // of circles of this and the next larger radius
};

struct CenterGuesses {
    std::vector<CenterGuess> best;  // at most one for each radius, with an excess above 0
    bool has_circles = false;       // false: velocities are too few at every place
};

// Tries places 6 km apart: all within the sweep's reach, or all within `around_m` of `near`.
[[nodiscard]] CenterGuesses guess_centers(const PolarVelocity& field, double rotation,
                                          std::optional<grid::PlanePoint> near, double around_m);

struct FoundCenter {
    VortexProfile profile;
    double error_m = 0;     // scatter of the simplex's starts
    double excess_mps = 0;  // of the strongest ring and one outside it
};

// Refines a guess. Moves bins of the field by whole turns to agree with the fitted wind. Returns
// none if no circles can be fitted.
[[nodiscard]] std::optional<FoundCenter> refine_center(PolarVelocity& field, double rotation,
                                                       const CenterGuess& guess);

}  // namespace stormcellar::retrieve
