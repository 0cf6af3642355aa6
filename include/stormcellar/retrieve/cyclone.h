// stormcellar/retrieve/cyclone.h -- the wind of a hurricane from the velocities of one radar:
// center, tangential and radial wind by radius, mean wind, and the fall of pressure to the center.
//
// The lowest sweep with velocities shows the hurricane on circles about its center. On each circle,
// a Fourier series is fitted to the velocity times the distance from the radar (GVTD). The center
// is the place whose circles show the greatest angular momentum of that series.
//
// Source    GVTD: Jou, Lee, Liu and Kao (2008). Waves and gaps: Lee, Jou, Chang and Deng (1999).
//           Center by simplex: Lee and Marks (2000). Scatter of its starts: Bell and Lee (2012).
//           Weighting the wind by the center's distance, search of the whole plane, refolding and
//           tests of significance are our own.
// Units     Meters, degrees, m/s, hPa. Heights are above the antenna. Tangential wind is positive
//           in the sense of cyclones of the hemisphere, radial wind outward. The wind along the
//           beam is positive away from the radar through the center, the wind across it to the left
//           of that direction.
// Folds     The wind of a circle and of the circle beside it predicts each velocity. A velocity
//           that differs from this prediction by more than the Nyquist velocity gets another fold
//           number. So a wrong fold number from dealias() does no harm where most other fold
//           numbers are right.
// Errors    Each result has one standard error. The error of the center is the scatter of the
//           simplex's starts and radii, which is a lower bound. The errors of the wind combine the
//           residuals of the fit, the error of the center, the width of the beam and the unknown
//           wind across the beam. One radar cannot tell a mean wind across the beam from a
//           tangential wind: a mean wind across the beam changes the tangential wind of a circle of
//           radius R by its own speed times R / distance. If the mean wind is unknown, the wind
//           across the beam counts as 0 with an error of 5 m/s; if it is known, its error is 2 m/s.
// Accuracy  tests/retrieve/cyclone_test.cpp simulates hurricanes of 40 to 65 m/s, whose maximum is
//           15 to 40 km from a center that is 60 to 140 km away. Their wind includes a mean wind,
//           an asymmetry of wave 1 of up to 20 % and 1 m/s of noise. Velocities are folded at 12 to
//           33 m/s and unfolded by `anchored`. The center is within 1 km, the maximum tangential
//           wind within 5 %. Harvey of 2017 has 56 m/s for each rung of dealias() except `off`, and
//           its center is within 5 km of the middle of the eye (tests/retrieve/harvey_test.cpp).
// Limits    The wind is at the height of one beam, not at the surface. Asymmetries of the radial
//           wind, and waves above 2 of the tangential wind, cannot be told from the waves that are
//           fitted. Gradient wind balance does not hold in the layer of friction.
// Threads   Pure functions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "stormcellar/grid/site_frame.h"
#include "stormcellar/level2/volume.h"
#include "stormcellar/retrieve/dealias.h"

namespace stormcellar::retrieve {

struct Estimate {
    double value = 0;
    double error = 0;  // standard error
};

struct HorizontalWind {
    double east_mps = 0, north_mps = 0;  // components toward the east and the north
};

struct CycloneOptions {
    // First guess of the center, at most 40 km off. None: search the whole sweep.
    std::optional<grid::GeoPoint> near;
    // The wind that carries the hurricane, often close to its motion. Only the component across the
    // beam is used.
    std::optional<HorizontalWind> mean_wind;
};

struct CycloneRing {
    double radius_m = 0;
    Estimate tangential_mps;      // VT0, mean of the circle
    double across_error_mps = 0;  // the part of VT0's error due to the mean wind across
    Estimate radial_mps;          // VR0, mean of the circle
    double wave1_mps = 0;         // amplitude of the tangential wind's wave 1; 0 if `waves` is 1
    int waves = 0;                // number of waves that were fitted
    double coverage = 0;          // share of the circle with velocities
    double largest_gap_deg = 0;
};

struct Cyclone {
    std::size_t sweep = 0;  // index in the volume
    double elevation_deg = 0;
    grid::GeoPoint center;
    grid::PlanePoint center_plane;  // in the azimuthal equidistant plane about the site
    double center_error_m = 0;      // scatter of the simplex's starts
    double distance_m = 0;          // from the radar to the center
    double height_m = 0;            // of the beam over the center
    // By radius, 1 km apart, without gaps of more than 5 km
    std::vector<CycloneRing> rings;
    std::size_t strongest = 0;  // index of the ring of maximum wind
    Estimate along_mps;         // the mean wind along the beam
    Estimate across_mps;        // the mean wind across: as given, else 0
    // Pressure of the outermost ring minus pressure of the center, at the height of the beam
    Estimate pressure_deficit_hpa;
    // Share of the sweep's velocities whose fold number disagreed with the fitted wind and was
    // changed
    double refolded_share = 0;

    [[nodiscard]] const CycloneRing& maximum() const { return rings[strongest]; }
};

enum class NoCycloneReason : std::uint8_t {
    no_velocities,       // the volume has no velocities
    no_nyquist,          // the velocities have no Nyquist velocity, so they may be folded
    no_position,         // the radar's position is unknown
    out_of_reach,        // the given center is beyond the velocities
    too_few_velocities,  // no circle is covered well enough
    no_vortex,           // a uniform wind and scatter explain all tangential wind
    radar_inside,        // the radar is inside the radius of maximum wind
    no_maximum,          // the wind still grows where the velocities end
};

struct NoCyclone {
    NoCycloneReason reason = NoCycloneReason::no_velocities;
    std::string text;  // one line for a user
};

// Returns the hurricane, or the reason why the velocities cannot show one. `folds` is the result of
// dealias() for this volume; with Dealiasing::off, folded velocities can look like a hurricane.
[[nodiscard]] tl::expected<Cyclone, NoCyclone> find_cyclone(const level2::Volume& volume,
                                                            const Dealiased& folds,
                                                            const CycloneOptions& options = {});

}  // namespace stormcellar::retrieve
