// tests/grid/slow_ray.h -- a ray through spherical layers, by quadrature of Bouguer's law.
//
// n r cos(elevation) = C gives range and arc between two heights as integrals over height, taken
// layer by layer between turning points by the tanh-sinh rule in 113-bit floats. Nothing is stepped
// along the ray.
#pragma once

#include "stormcellar/grid/ray_tracer.h"

namespace stormcellar::grid::testing {

struct SlowRay {
    double range_m = 0;
    double arc_m = 0;
};

// Returns where a ray that has passed `turns` turning points reaches a height; NaN if it never
// does. Uses radius, altitude, elevation and kind of range of the options.
[[nodiscard]] SlowRay slow_ray(const RefractivityProfile& profile, const RayOptions& options,
                               int turns, double height_m);

}  // namespace stormcellar::grid::testing
