// stormcellar/retrieve/rain_rate.h -- the rain rate of a gate, from reflectivity, and from KDP
// where KDP is better.
//
// Method    Z = 300 R^1.4, the default of NEXRAD (Fulton et al. 1998), with reflectivity capped at
//           53 dBZ, above which hail makes the echo. From 40 dBZ on, R = 44 KDP^0.822 (Ryzhkov et
//           al. 2005) replaces this rate where KDP is at least 0.5 degrees/km and four times its
//           error, so that the error of KDP changes the rate by less than about a fifth.
// Units     dBZ, degrees/km, mm/h.
// Accuracy  Exact formulas (tests/retrieve/rain_rate_test.cpp), which themselves err by a factor of
//           two in single showers.
// Not covered  The rate is at the height of the beam, not at the ground. In the melting layer the
//           rate is too high. Snow is no rain. Evaporation and growth below the beam are unknown.
//           The calibration of the radar is not corrected. All echo counts as rain, so leave out
//           echo that is probably no weather first (quality.h).
// Threads   Pure functions.
#pragma once

namespace stormcellar::retrieve {

inline constexpr double hail_cap_dbz = 53;

// Returns the rate by reflectivity; NaN for NaN.
[[nodiscard]] double rain_by_reflectivity_mm_per_h(double dbz);
// Returns the rate by KDP; 0 for a KDP that is not positive, NaN for NaN.
[[nodiscard]] double rain_by_kdp_mm_per_h(double deg_per_km);
// Returns the rate by KDP where KDP is better, else by reflectivity. If there is no KDP, pass NaN.
[[nodiscard]] double rain_rate_mm_per_h(double dbz, double kdp_deg_per_km, double kdp_error);

}  // namespace stormcellar::retrieve
