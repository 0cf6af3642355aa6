// synth/velocity_truth.h -- computes the true radial velocity of every gate of a simulated sweep.
//
// The truth is neither folded nor noisy. The tests of everything that is computed from velocities
// compare with this truth.
//
// Units     m/s, positive away from the radar; fold numbers.
// Accuracy  Without noise, shown + 2 n nyquist is within half a code, 0.25 m/s, of the truth of its
//           gate (tests/synth/velocity_truth_test.cpp). With noise, the fold number n is right for
//           every gate whose noise is below the Nyquist velocity.
// Errors    None. The truth is empty for sweeps without velocities, and for cuts that are not in
//           the scene.
// Threads   A pure function.
#pragma once

#include <cstdint>
#include <vector>

#include "stormcellar/level2/volume.h"
#include "synth/synth_scene.h"

namespace stormcellar::synth {

enum class VelocitySample : std::uint8_t {
    point,  // the air at the center of the gate
    // The air of the whole gate, averaged as by the scene's instrument: over the beam and the
    // pulse, weighted by reflectivity, together with clutter. Without a beam width, a pulse and
    // clutter, this is the same as `point`.
    gate,
};

struct VelocityTruth {
    // Both have the rows of the sweep's velocities: radials x gate_stride.
    std::vector<double> away_mps;    // NaN if the truth has no echo there (speckle, noise)
    std::vector<std::int8_t> folds;  // 0 if away_mps is NaN or the gate shows no velocity
};

// Returns the truth of a sweep of any volume of the scene, either as observed or as read from its
// file.
[[nodiscard]] VelocityTruth velocity_truth(const Scene& scene, const level2::Sweep& sweep,
                                           VelocitySample sample);

}  // namespace stormcellar::synth
