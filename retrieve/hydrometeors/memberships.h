// retrieve/hydrometeors/memberships.h -- how well the variables of a gate fit each class of
// hydrometeors.
//
// Source    Tables 1 to 3 of Park et al. (2009).
// Threads   Pure functions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "stormcellar/retrieve/hydrometeors.h"

namespace stormcellar::retrieve {

// NaN: unknown.
struct GateVariables {
    static constexpr float unknown = std::numeric_limits<float>::quiet_NaN();
    float reflectivity_dbz = unknown, zdr_db = unknown, correlation = unknown;
    float log_kdp = unknown;  // 10 lg of KDP in degrees/km, at least -30
    float reflectivity_deviation_db = unknown, phase_deviation_deg = unknown;
    float speed_mps = unknown;  // without its sign
};

// The place of a beam, which has a width, relative to the melting layer.
enum class BeamPlace : std::uint8_t {
    below,         // all of it below the layer
    center_below,  // it reaches into the layer from below
    inside,        // its center is in the layer
    center_above,  // it reaches into the layer from above
    above,
};

// Returns the class that fits best among the classes that are possible at a place. Returns none if
// no class fits, or if reflectivity, ZDR or the correlation is unknown.
[[nodiscard]] Hydrometeor best_class(const GateVariables& gate, BeamPlace place);

}  // namespace stormcellar::retrieve
