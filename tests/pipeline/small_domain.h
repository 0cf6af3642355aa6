// tests/pipeline/small_domain.h -- three consecutive volumes of KBGM, and a coarse domain around
// it.
#pragma once

#include <string>
#include <vector>

#include "pipeline/options/domain.h"
#include "stormcellar/grid/grid_spec.h"

namespace stormcellar::pipeline {

inline const std::vector<std::string> sequence = {
    "KBGM20050822_024414.gz", "KBGM20050822_025001.gz", "KBGM20050822_025549.gz"};

// Five levels of `columns` times `columns` cells of 4 km.
inline grid::GridSpec coarse_spec(double latitude_deg, double longitude_deg, int columns) {
    grid::GridSpec spec = grid::default_spec(latitude_deg, longitude_deg);
    spec.nx = spec.ny = columns;
    spec.spacing_m = 4000;
    spec.levels_m = {1000, 2000, 3000, 5000, 8000};
    return spec;
}

inline Domain small_domain() {
    Domain domain;
    domain.name = "north";
    domain.spec = coarse_spec(42.2, -75.9, 100);
    return domain;
}

}  // namespace stormcellar::pipeline
