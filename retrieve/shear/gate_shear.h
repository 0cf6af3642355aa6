// retrieve/shear/gate_shear.h -- the shear of the gates of one sweep, in rows by azimuth.
//
// Units     As stormcellar/retrieve/velocity_shear.h.
// Threads   Pure functions.
#pragma once

#include <vector>

#include "retrieve/shear/velocity_rows.h"
#include "stormcellar/base/result.h"
#include "stormcellar/level2/volume.h"
#include "stormcellar/retrieve/velocity_shear.h"

namespace stormcellar::retrieve {

// In s^-1; all 0 unless the gate is fitted.
struct ShearOfGate {
    float azimuthal = 0, azimuthal_error = 0;
    float divergence = 0, divergence_error = 0;
    bool is_fitted = false;
};

struct GateShear {
    VelocityRows rows;
    std::vector<ShearOfGate> gates;  // rows x rows.gates
};

// Return bad_argument for options that make no sense, and for fold numbers that are not those of a
// velocity moment of the volume.
[[nodiscard]] Result<void> check_shear_options(const ShearOptions& options);
[[nodiscard]] Result<void> check_folds(const level2::Volume& volume, const SweepFolds& folds);

// Computes the shear of the gates up to a range. Returns the errors of sweep_shear().
[[nodiscard]] Result<GateShear> gate_shear(const level2::Volume& volume, const SweepFolds& folds,
                                           const ShearOptions& options, double farthest_m);

}  // namespace stormcellar::retrieve
