// tests/retrieve/layered_volume.h -- volumes with dual polarization whose precipitation a test
// gives as a function of height, seen with noise through a beam with a width.
//
// Units    Meters above the antenna, degrees, dBZ, dB.
// Threads  Pure functions.
#pragma once

#include <functional>
#include <vector>

#include "stormcellar/level2/volume.h"

namespace stormcellar::retrieve {

// The precipitation at a point of the air.
struct DualPoint {
    double dbz = -100;  // below -50: nothing
    double zdr_db = 0.2;
    double rho = 0.993;
    double kdp_deg_per_km = 0;
};

struct LayeredSpec {
    std::vector<double> elevations_deg = {4.3, 6, 9.9};
    int radials = 180, gates = 320;
    double azimuth_from_deg = 0, azimuth_to_deg = 360;  // of the echo
    unsigned seed = 1;
};

// Makes a volume of KTLX. `point` gets azimuth, range along the earth and height. Each gate is the
// mean over the two-way pattern of a beam of 0.95 degrees, in height only. Then reflectivity gets
// noise of 1 dB, ZDR of 0.3 dB, PHI of 2 degrees, and RHO of 0.006 and an eighth of 1 - RHO.
[[nodiscard]] level2::Volume layered_volume(
    const LayeredSpec& spec,
    const std::function<DualPoint(double azimuth_deg, double arc_m, double height_m)>& point);

// Snow that melts between two heights.
struct MeltingProfile {
    double bottom_m = 2500, top_m = 3000;
    double depth = 0.06;               // of the minimum of RHO
    double rain_dbz = 28;              // below the layer
    double bright_db = 7, zdr_db = 1;  // of the maxima above rain and snow
    double sharpness = 2.5;            // of all three; 2: parabolas
    double low_place = 0.6;            // of the minimum of RHO, from the top (0) to the bottom (1)

    [[nodiscard]] DualPoint at(double height_m) const;
};

}  // namespace stormcellar::retrieve
