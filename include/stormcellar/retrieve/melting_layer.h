// stormcellar/retrieve/melting_layer.h -- bottom and top of the layer in which snow melts, from one
// volume with dual polarization.
//
// Method    Melting snow has a low correlation coefficient (RHO), a high reflectivity and a high
//           ZDR. Sweeps from 3.8 to 10.2 degrees give profiles of these moments over height, one
//           for each sector of 30 degrees of azimuth, from gates of 15 to 47 dBZ. A profile shows a
//           layer if its RHO has a minimum of 0.8 to 0.985, at least 0.006 below the air within 1.2
//           km above and below, if its reflectivity is at least 1.5 dB and its ZDR at least 0.2 dB
//           above those of the snow, and if its maximum of reflectivity is at least 20 dBZ. The
//           power of melting snow is linear reflectivity times what RHO lacks there. Bottom and top
//           are 3.1 standard deviations of this power below and above its mean height, after the
//           variance of the beam was taken away, because a beam spreads power. At least three
//           profiles, and two thirds of those with a minimum, must agree within 700 m. If the
//           sectors have too little echo, whole circles take their place.
// Units     Meters above the antenna.
// Errors    not_found, with the reason: no dual polarization, no sweep at these elevations, too
//           little stratiform echo, no layer (all snow, all rain, or convective echo), a layer that
//           may begin below the lowest height seen, or profiles that disagree.
// Accuracy  tests/retrieve/melting_layer_test.cpp makes 24 layers of 300 to 800 m with tops from
//           1.2 to 5.2 km, seen with noise by beams with a width in one, three or five sweeps. All
//           are found. Bottoms and tops err by at most 130 m, 70 m rms; 65 % are within the stated
//           error, and all within twice that. Tops that differ by 1 km from side to side are met
//           within 200 m in each sector.
// Not covered  Layers that begin below 300 m or reach above 6.5 km, and two layers above each
//           other. Beyond 25 km, where the beam blurs the layer, its depth is mostly the usual one,
//           590 m. Real layers vary in shape, and no soundings were at hand to measure that.
// Source    Idea: Giangrande, Krause and Ryzhkov (2008), J. Appl. Meteor. Climatol. 47, 1354, whose
//           layers have RHO of 0.90 to 0.97 below a maximum of 30 to 47 dBZ and of 0.8 to 2.5 dB.
//           Their tops err by about 200 m (rms) within 60 km. Sanchez-Rivas and Rico-Ramirez (2021,
//           AMT 14, 2873) report 200 to 250 m for the level of 0 C.
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
    // The first sector begins at north. A sector without profiles of its own has none.
    std::array<std::optional<LayerHeights>, sector_count> sectors;
    int profiles = 0;  // that agree

    // Returns the sector of an azimuth in degrees; the first for NaN and infinity.
    [[nodiscard]] static std::size_t sector_of(double azimuth_deg);
    // Returns the heights of the sector at an azimuth in degrees, or else of the whole volume.
    [[nodiscard]] const LayerHeights& at(double azimuth_deg) const;
};

// Finds the melting layer of a volume. Errors: see above.
[[nodiscard]] Result<MeltingLayer> melting_layer(const level2::Volume& volume);

// Compares the top of the layer, where the air has about 0 C, with a height of 0 C above mean sea
// level that was assumed. Returns a note for the provenance of grids if they are more than 500 m
// apart. Empty if they are not, or if there is no layer or no position of the radar.
[[nodiscard]] std::string zero_c_note(const level2::Volume& volume, double assumed_m);
// Returns the first of such notes, without the station before it; empty if there is none.
[[nodiscard]] std::string zero_c_in_notes(std::span<const std::string> notes);

}  // namespace stormcellar::retrieve
