// tests/grid/square_spec.h -- makes the spec of a square grid.
#pragma once

#include "stormcellar/grid/grid_spec.h"

namespace stormcellar::grid {

// Returns the default spec with `side` columns and rows.
[[nodiscard]] inline GridSpec square_spec(double latitude_deg, double longitude_deg, int side,
                                          double spacing_m = 1000) {
    GridSpec spec = default_spec(latitude_deg, longitude_deg);
    spec.nx = spec.ny = side;
    spec.spacing_m = spacing_m;
    return spec;
}

}  // namespace stormcellar::grid
