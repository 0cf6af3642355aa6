// synth/observe.h -- makes a simulated radar observe a scene: one volume of message 31.
//
// Without instrument effects (synth/instrument.h), each gate is a point sample of the truth at its
// center, at the time of its radial, along a beam over an earth of 4/3 radius
// (stormcellar/grid/beam_geometry.h). Reflectivity below the radar's detection limit
// (grid/beam/detection_limit.h, with the calibration of the radials) is code 0. Velocity is the
// radial part of the scene's wind, or of the motion of the features if the scene has no wind.
// Velocity is positive away from the radar, not aliased, and clamped at +-63 m/s. The spectrum
// width is 2 m/s wherever there is a velocity. Gates extend as far as in real volumes: up to a
// height of 21.3 km (70,000 ft), and out to 460 km for reflectivity and 300 km for the other
// moments. The first center is at 2,125 m, and gates are 250 m apart.
//
// The effects come in this order: the mean over the beam and the pulse; clutter; range folding
// (code 1 in VEL and SW, in Doppler and batch cuts); noise; velocity folding; the detection limit;
// speckle; missing gates. Sweeps lack their lost radials, and volumes lack sweeps without radials.
// The numbers of radials and sweeps then have gaps, as in real volumes.
//
// Accuracy  REF is within half a code, 0.25 dB, of the truth; VEL within 0.25 m/s.
// Threads   A pure function of its arguments, with the same bits every time.
#pragma once

#include "stormcellar/level2/volume.h"
#include "synth/synth_scene.h"

namespace stormcellar::synth {

inline constexpr float spectrum_width_mps = 2;

// Makes volume `number` of the scene, counted from 0.
[[nodiscard]] level2::Volume observe(const Scene& scene, int number);

// Returns the file name of public data sets: "KTLX20240601_220000_V06".
[[nodiscard]] std::string volume_file_name(const Scene& scene, int number);

}  // namespace stormcellar::synth
