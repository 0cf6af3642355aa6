// stormcellar/retrieve/hail.h -- severe hail index, probability of severe hail and expected size of
// hail from a column of reflectivity.
//
// Method    The flux of kinetic energy of hail, 5e-6 * 10^(0.084 dBZ) * W, is integrated over
//           height from the level of 0 C up. W grows from 0 at 40 dBZ to 1 at 50 dBZ. A second
//           weight grows from 0 at the level of 0 C to 1 at the level of -20 C. A tenth of the
//           integral is the severe hail index (SHI). From SHI follow
//             POSH    29 ln(SHI / WT) + 50, from 0 to 100 %: probability of hail of at least 19 mm
//             WT      57.5 H - 121, at least 20 J/m/s; H is the height of 0 C above the radar in km
//             MESH    2.54 SHI^0.5, a size that a quarter of the reported stones exceed
//             MESH75  15.096 SHI^0.206, as MESH, but from 5,897 reports instead of 147
//             MESH95  22.157 SHI^0.212, a size that 5 % of the reported stones exceed
// Layers    Each height of a column is the middle of a layer, which reaches half way to the next
//           heights; the first and the last layer are symmetric. Reflectivity is constant in a
//           layer. The weight of temperature is integrated over the layer, because a layer may
//           contain the level of 0 C.
// Units     Heights are above mean sea level, in meters. SHI: J m^-1 s^-1. Sizes: mm.
// Source    Witt et al. (1998), Wea. Forecasting 13, 286. MESH75 and MESH95: Murillo and Homeyer
//           (2019), J. Appl. Meteor. Climatol. 58, 947, with the coefficients of its corrigendum
//           (2021), doi:10.1175/JAMC-D-20-0271.1.
// Errors    bad_argument for levels or heights that make no sense.
// Accuracy  Enforced by hail_test.cpp:
//             constant reflectivity  1e-6 of the closed form
//             storm-like profile     MESH from layers of 500 m: within 1 mm of layers of 10 m
//           bench/compare_hail.py compares pyhail and recast-radar.
// Not covered  The sizes are statistics of reports, not measurements: they are too small for large
//           stones. Wet or tilted storms, other bands than S, and attenuation. Cells that no beam
//           met add nothing, so that SHI is too low.
// Threads   Pure functions.
#pragma once

#include <span>
#include <vector>

#include "stormcellar/base/result.h"

namespace stormcellar::retrieve {

// Heights above mean sea level at which the air has 0 and -20 degrees Celsius. The default is an
// assumption for a warm day with severe storms on the Great Plains: 20 degrees in 3100 m, as in the
// standard atmosphere. A sounding or a model gives the true heights.
struct FreezingLevels {
    double zero_c_m = 4200, minus_20_c_m = 7300;
    bool operator==(const FreezingLevels&) const = default;
};

// Returns bad_argument unless 0 C is from -1000 to 7000 m, and -20 C is 1000 to 8000 m higher.
[[nodiscard]] Result<void> validate(const FreezingLevels& levels);

// The usual error of both levels, for mesh_range().
inline constexpr double usual_level_error_m = 300;

// All numbers are 0 if no layer of at least 40 dBZ reaches above the level of 0 C.
struct Hail {
    float shi_j_per_m_s = 0;
    float posh_percent = 0;
    float mesh_mm = 0, mesh75_mm = 0, mesh95_mm = 0;
};

// The part of the method that depends on heights alone, so columns with the same heights share it.
struct HailLayers {
    // SHI is the sum of hail_energy_flux() times the weight of each height.
    std::vector<double> weights_m;
    double warning_threshold = 0;  // WT, J m^-1 s^-1
};

// Computes the weights of a column. Heights must grow, and there must be at least two of them.
// `radar_m` is the height of the radar.
[[nodiscard]] Result<HailLayers> hail_layers(std::span<const double> heights_m,
                                             const FreezingLevels& levels, double radar_m);

// Computes the flux of kinetic energy, J m^-2 s^-1. NaN gives 0. Values above 100 dBZ, which no
// radar reports, count as 100 dBZ.
[[nodiscard]] double hail_energy_flux(double dbz);

// Computes the hail of a column. `dbz` has a value for each height; NaN, and missing values at the
// end, add nothing.
[[nodiscard]] Hail hail_of_column(const HailLayers& layers, std::span<const float> dbz);

// Computes the hail that follows from SHI. Zero, negative numbers and NaN give no hail.
[[nodiscard]] Hail hail_of_shi(double shi_j_per_m_s, double warning_threshold);

// MESH of a column if both levels are too low or too high by the same error.
struct MeshRange {
    float least_mm = 0, most_mm = 0;
};
// Computes the range for levels that may err by `error_m`. Returns the errors of hail_layers().
[[nodiscard]] Result<MeshRange> mesh_range(std::span<const double> heights_m,
                                           std::span<const float> dbz, const FreezingLevels& levels,
                                           double error_m);

}  // namespace stormcellar::retrieve
