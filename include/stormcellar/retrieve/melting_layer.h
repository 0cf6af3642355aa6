// stormcellar/retrieve/melting_layer.h -- bottom and top of the layer in which snow melts, from one
// volume with dual polarization.
//
// Method    Melting snow has a low correlation coefficient (RHO), a high reflectivity and a high
//           ZDR. Sweeps from 3.8 to 10.2 degrees give profiles of these moments over height, one
//           for each sector of 30 degrees of azimuth, from gates of 15 to 47 dBZ. A profile shows a
//           layer under three conditions. Its RHO has a minimum of 0.8 to 0.985, at least 0.006
//           below the air within 1.2 km above and below. Its reflectivity is at least 1.5 dB and
//           its ZDR at least 0.2 dB above those of the snow. Its maximum of reflectivity is at
//           least 20 dBZ. The power of melting snow at a height is the linear reflectivity times
//           the difference of RHO from the air above or below. From this power the mean height and
//           its variance are computed. The beam spreads power, so the variance of the beam is
//           subtracted. Bottom and top are 3.1 standard deviations below and above the mean height.
//           At least three profiles, and two thirds of the profiles with a minimum, must agree
//           within 700 m. If the sectors have too little echo, whole circles take their place.
// Units     Meters above the antenna.
// Errors    not_found, with the reason: no dual polarization, no sweep at these elevations, too
//           little stratiform echo, no layer (all snow, all rain, or convective echo), a layer that
//           may begin below the lowest height seen, or profiles that disagree.
// Accuracy  tests/retrieve/melting_layer_test.cpp makes 24 layers of 300 to 800 m with tops from
//           1.2 to 5.2 km, seen with noise by beams with a width in one, three or five sweeps. All
//           are found. Bottoms and tops err by at most 130 m, 70 m rms; 65 % are within the stated
//           error, and all within twice the stated error. If tops differ by 1 km from side to side,
//           the top of each sector is within 200 m.
// Not covered  Layers that begin below 300 m or reach above 6.5 km, and two layers above each
//           other. Beyond 25 km, where the beam blurs the layer, its depth is mostly the usual
//           depth, 590 m. Real layers vary in shape; the errors were not compared with soundings.
// Source    Idea: Giangrande, Krause and Ryzhkov (2008), J. Appl. Meteor. Climatol. 47, 1354, whose
//           layers have RHO of 0.90 to 0.97 below a maximum of reflectivity (30 to 47 dBZ) and of
//           ZDR (0.8 to 2.5 dB). Their tops err by about 200 m (rms) within 60 km. Sanchez-Rivas
//           and Rico-Ramirez (2021, AMT 14, 2873) report 200 to 250 m for the level of 0 C.
// Threads   Pure functions.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "stormcellar/base/result.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::retrieve {

// Errors are standard deviations.
struct LayerHeights {
    double bottom_m = 0, top_m = 0;
    double bottom_error_m = 0, top_error_m = 0;
};

struct MeltingLayer {
    static constexpr std::size_t sector_count = 12;

    LayerHeights heights;  // of the whole volume
    // The first sector begins at north. A sector without profiles of its own has no heights.
    std::array<std::optional<LayerHeights>, sector_count> sectors;
    int profiles = 0;  // number of profiles that agree

    // Returns the sector of an azimuth in degrees; the first for NaN and infinity.
    [[nodiscard]] static std::size_t sector_of(double azimuth_deg);
    // Returns the heights of the sector at an azimuth in degrees, or else of the whole volume.
    [[nodiscard]] const LayerHeights& at(double azimuth_deg) const;
};

// Finds the melting layer of a volume. Errors: see above.
[[nodiscard]] Result<MeltingLayer> melting_layer(const level2::Volume& volume);

// Compares the top of the layer, where the air has about 0 C, with a height of 0 C above mean sea
// level that was assumed. Returns a note for the provenance of grids if they are more than 500 m
// apart. Returns an empty text if they are nearer, or if there is no layer or no position of the
// radar.
[[nodiscard]] std::string zero_c_note(const level2::Volume& volume, double assumed_m);
// Returns the first note of zero_c_note() among `notes`, without the station before it; empty if
// there is none.
[[nodiscard]] std::string zero_c_in_notes(std::span<const std::string> notes);

}  // namespace stormcellar::retrieve
