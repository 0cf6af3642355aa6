// synth/observe.h -- a radar looks at a scene: one volume of message 31.
//
// Each gate is a point sample of the truth at its centre, at the time of its radial, along a beam
// over an earth of 4/3 radius (stormcellar/grid/beam_geometry.h). Reflectivity below the radar's
// detection limit (grid/beam/detection_limit.h, with the calibration that the radials carry) is
// code 0. Velocity is the radial part of the features' motion, positive away, and is not aliased;
// beyond +-63 m/s it is clamped. Spectrum width is 2 m/s wherever there is velocity. Gates reach as
// far as the RDA's: to 21.3 km (70,000 ft) of height, reflectivity to 460 km and the rest to 300
// km, the first centre at 2,125 m, 250 m apart. Accuracy: REF within half a code, 0.25 dB, of the
// truth; VEL within 0.25 m/s. That is a scene whose instrument does nothing (synth/instrument.h).
// Effects come in this order: mean over the beam and the pulse; clutter; range folding (codes 1 of
// VEL and SW, in Doppler and batch cuts); noise; velocity folding; the detection limit. Radials
// that are lost are not in their sweep, nor sweeps without radials in the volume: numbers then have
// gaps, as in real ones. Threads: a pure function of its arguments; the same bits every time.
#pragma once

#include "stormcellar/level2/volume.h"
#include "synth/synth_scene.h"

namespace stormcellar::synth {

inline constexpr float spectrum_width_mps = 2;

// Volume `number` of the scene, from 0.
[[nodiscard]] level2::Volume observe(const Scene& scene, int number);

// As public data sets name it: "KTLX20240601_220000_V06".
[[nodiscard]] std::string volume_file_name(const Scene& scene, int number);

}  // namespace stormcellar::synth
