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

inline Domain small_domain() {
    Domain domain;
    domain.name = "north";
    domain.spec = grid::default_spec(42.2, -75.9);
    domain.spec.nx = domain.spec.ny = 100;
    domain.spec.spacing_m = 4000;
    domain.spec.levels_m = {1000, 2000, 3000, 5000, 8000};
    return domain;
}

}  // namespace stormcellar::pipeline
