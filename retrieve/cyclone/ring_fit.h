// retrieve/cyclone/ring_fit.h -- fits the wind on a circle about the center of a cyclone to the
// velocities along the beam (GVTD: ground-based velocity track display, generalized).
//
// Let the x axis point from the radar to the center, at the distance RT, and let t be the angle
// about the center, counterclockwise from x. For a point of the circle at the distance D from the
// radar, velocity * D / RT is an exact Fourier series in t: a[0] + sum of a[n] cos nt + b[n] sin
// nt. With a tangential wind of waves 0 to 2, a radial wind of wave 0 and a mean wind (along,
// across), the coefficients of the series are
//   a0 = along + r VR0 - VTS1 / 2
//   a1 = r along + VR0 - VTS2 / 2    b1 = r across - VT0 + VTC2 / 2
//   a2 = VTS1 / 2                    b2 = -VTC1 / 2
//   a3 = VTS2 / 2                    b3 = -VTC2 / 2
// with r = R / RT for a circle of radius R. The mean wind across the beam cannot be separated from
// VT0.
//
// Source    Jou, Lee, Liu and Kao (2008). Gaps and waves: Lee, Jou, Chang and Deng (1999).
// Units     Meters in the plane about the site; m/s. VT0 in these formulas is positive
//           for counterclockwise winds.
// Threads   Pure functions.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "retrieve/cyclone/polar_velocity.h"

namespace stormcellar::retrieve {

// The coefficients a0, a1, b1, a2, b2, a3, b3.
using RingSeries = std::array<double, 7>;
// Returns the sum of the series at an angle.
[[nodiscard]] double series_at(const RingSeries& series, double cosine, double sine);

struct RingRequest {
    grid::PlanePoint center;
    double radius_m = 0;
    int samples = 72;    // points of the circle at which the velocities are read
    int most_waves = 3;  // of the series; at most 3
    // 1 where cyclones turn counterclockwise (north of the equator), else -1
    double rotation = 1;
    // The series of a neighboring circle, which gives the expected velocities; null: there are
    // none.
    const RingSeries* expected = nullptr;
};

struct RingFit {
    RingSeries series{};
    int waves = 0;
    double coverage = 0;         // share of the points with a velocity
    double largest_gap_deg = 0;  // between points with a velocity
    // VT0 if no mean wind blows across the beam; positive if the wind turns as in a cyclone
    double tangential_mps = 0;
    double radial_mps = 0;  // VR0, positive outward
    double along_mps = 0;   // mean wind along the beam, away from the radar
    double wave1_mps = 0;   // amplitude of VTC1 and VTS1; 0 below two waves
    // Standard errors, from the residuals and their correlation between neighboring points
    double tangential_error_mps = 0, radial_error_mps = 0, along_error_mps = 0;
    double residual_mps = 0;  // root mean square
};

// Fits as many waves as the largest gap allows: 3 up to 30 degrees, 2 up to 60, 1 up to 90. Drops
// points that are far off, such as wrong fold numbers, and fits once more. Returns none if a gap is
// wider than 90 degrees, if points are too few, or if the circle reaches 0.9 of the distance to the
// radar.
[[nodiscard]] std::optional<RingFit> fit_ring(const PolarVelocity& field,
                                              const RingRequest& request);

}  // namespace stormcellar::retrieve
