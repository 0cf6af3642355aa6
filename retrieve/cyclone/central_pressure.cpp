#include "retrieve/cyclone/central_pressure.h"

#include <algorithm>
#include <cmath>

#include "base/degree.h"

namespace stormcellar::retrieve {
namespace {

constexpr double rotation_rate = 7.292115e-5;  // of the earth, rad/s
constexpr double pascals_per_hpa = 100;
constexpr double density_error = 0.05;

// Returns the density of the standard atmosphere (ICAO 1993) below 11 km, in kg/m3.
double density_at(double altitude_m) {
    return 1.225 * std::pow(1 - 2.25577e-5 * std::clamp(altitude_m, 0.0, 11'000.0), 4.25588);
}

// Returns the integral of V^2 / r + f V. V at each ring is the estimate plus `errors` times its
// error.
double integral_of(std::span<const CycloneRing> rings, double coriolis, double errors) {
    const auto wind = [&](const CycloneRing& ring) {
        return std::max(0.0, ring.tangential_mps.value + errors * ring.tangential_mps.error);
    };
    const auto slope = [&](const CycloneRing& ring) {
        return wind(ring) * wind(ring) / ring.radius_m + coriolis * wind(ring);
    };
    // With V = c r inside the innermost ring, the integral is V^2 / 2 + f V r / 2.
    double sum = rings.front().radius_m * slope(rings.front()) / 2;
    for (std::size_t i = 1; i < rings.size(); ++i)
        sum += (rings[i].radius_m - rings[i - 1].radius_m) *
               (slope(rings[i]) + slope(rings[i - 1])) / 2;
    return sum;
}

}  // namespace

Estimate pressure_deficit_hpa(std::span<const CycloneRing> rings, double latitude_deg,
                              double altitude_m) {
    if (rings.empty()) return {};
    const double coriolis = std::abs(2 * rotation_rate * std::sin(latitude_deg * degree));
    const double factor = density_at(altitude_m) / pascals_per_hpa;
    const double deficit = factor * integral_of(rings, coriolis, 0);
    const double by_wind =
        factor * (integral_of(rings, coriolis, 1) - integral_of(rings, coriolis, -1)) / 2;
    return {deficit, std::hypot(by_wind, density_error * deficit)};
}

}  // namespace stormcellar::retrieve
