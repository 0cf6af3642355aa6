// tests/grid/slow_ray.h -- a ray through spherical layers, by quadrature of Bouguer's law.
//
// The law says that n r cos(elevation) is constant along the ray, with the refractive index n and
// the distance r from the center of the earth. So range and arc between two heights are integrals
// over height. They are computed layer by layer between turning points, by the tanh-sinh rule in
// 113-bit floats, without stepping along the ray.
#pragma once

#include "stormcellar/grid/ray_tracer.h"

namespace stormcellar::grid::testing {

struct SlowRay {
    double range_m = 0;
    double arc_m = 0;
};

// Returns the point where a ray that has passed `turns` turning points reaches a height; NaN if the
// ray never reaches the height. Uses the options' radius, altitude, elevation and kind of range.
[[nodiscard]] SlowRay slow_ray(const RefractivityProfile& profile, const RayOptions& options,
                               int turns, double height_m);

}  // namespace stormcellar::grid::testing
