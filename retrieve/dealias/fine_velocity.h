// retrieve/dealias/fine_velocity.h -- the codes of velocities that are computed.
//
// Units     Steps of 0.01 m/s, in which radars send the Nyquist velocity, so raw + 2 n Nyquist is
//           exact.
// Threads   Pure functions.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "stormcellar/level2/volume.h"

namespace stormcellar::retrieve {

// Returns the code of a velocity, computed in its own precision. Its absolute value must be at most
// 320 m/s.
template <class Real>
[[nodiscard]] std::uint16_t fine_velocity_code(Real velocity_mps) {
    return static_cast<std::uint16_t>(std::lrint(velocity_mps * Real{100} + Real{32768}));
}

// Returns a copy of a velocity moment that has codes of this kind. All codes are 0. `gates` is the
// number of places in its rows.
[[nodiscard]] inline level2::SweepMoment with_fine_codes(const level2::SweepMoment& raw,
                                                         std::size_t gates) {
    level2::SweepMoment made = raw;
    made.word_size_bits = 16;
    made.scale = 100;
    made.offset = 32768;
    made.codes8.clear();
    made.codes16.assign(gates, 0);
    return made;
}

}  // namespace stormcellar::retrieve
