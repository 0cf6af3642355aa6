// retrieve/wind/vvp_fit.h -- fits a uniform wind to the velocities of one layer, and rejects gates
// that disagree.
//
// Units     m/s; parts of a unit vector toward the east, the north and up.
// Source    Holleman (2005). Standard errors by sectors: Liang and Zeger (1986).
// Threads   Pure function.
#pragma once

#include <span>
#include <vector>

#include "stormcellar/retrieve/wind_profile.h"

namespace stormcellar::retrieve {

struct VvpGate {
    static constexpr int sectors = 72;  // of azimuth
    float velocity_mps = 0;             // unfolded
    float nyquist_mps = 0;
    float east = 0, north = 0, up = 0;  // direction of the beam
    std::uint8_t sector = 0;
};

struct VvpFit {
    LayerWind wind;                      // without has_birds
    std::vector<std::uint8_t> was_used;  // 1 for each gate that was not rejected
};

[[nodiscard]] tl::expected<VvpFit, NoWind> fit_vvp(std::span<const VvpGate> gates);

}  // namespace stormcellar::retrieve
