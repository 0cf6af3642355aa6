// synth/velocity_truth.h -- the true radial velocity of every gate of a simulated sweep.
//
// The truth is neither folded nor noisy. Tests of everything that is computed from velocities
// compare with it.
//
// Units     m/s, positive away from the radar; fold numbers.
// Accuracy  shown + 2 n nyquist is within half a code, 0.25 m/s, of the truth of its gate, if the
//           scene has no noise (tests/synth/velocity_truth_test.cpp). With noise, the fold number n
//           is right for every gate whose noise is below the Nyquist velocity.
// Errors    None. The truth is empty for sweeps without velocities and for cuts that the scene does
//           not have.
// Threads   A pure function.
#pragma once

#include <cstdint>
#include <vector>

#include "stormcellar/level2/volume.h"
#include "synth/synth_scene.h"

namespace stormcellar::synth {

enum class VelocitySample : std::uint8_t {
    point,  // the air at the center of the gate
    // The air of the whole gate as the scene's instrument averages it: over the beam and the pulse,
    // weighted by reflectivity, together with clutter. Without a beam width, a pulse and clutter,
    // this is the same as `point`.
    gate,
};

struct VelocityTruth {
    // Both have rows like the velocities of the sweep: radials x gate_stride.
    std::vector<double> away_mps;    // NaN where the truth has no echo: speckle and noise
    std::vector<std::int8_t> folds;  // 0 where away_mps is NaN or the gate shows no velocity
};

// Returns the truth of a sweep of any volume of the scene, as observed or as read from its file.
[[nodiscard]] VelocityTruth velocity_truth(const Scene& scene, const level2::Sweep& sweep,
                                           VelocitySample sample);

}  // namespace stormcellar::synth
