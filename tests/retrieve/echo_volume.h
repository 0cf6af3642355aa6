// tests/retrieve/echo_volume.h -- makes volumes whose gates a test gives, to name their echo.
#pragma once

#include <functional>
#include <limits>
#include <vector>

#include "stormcellar/level2/volume.h"

namespace stormcellar::retrieve {

inline constexpr float no_echo = std::numeric_limits<float>::quiet_NaN();

struct EchoGate {
    float reflectivity_dbz = no_echo;
    float velocity_mps = no_echo, width_mps = no_echo;  // NaN: none
    float correlation = no_echo, phase_deg = no_echo;   // of volumes with dual polarization
};

struct EchoPlace {
    double elevation_deg = 0, azimuth_deg = 0, range_m = 0;
    double height_m = 0;  // above the antenna
};

struct EchoVolumeSpec {
    std::vector<double> elevations_deg = {0.5, 1.5, 2.5, 3.5, 4.5};
    int radials = 360, gates = 400;
    int gate_spacing_m = 500;
    bool has_dual = false;
};

// Makes a volume of KTLX at the time of its sun spike of 1999-05-04T00:00:34Z.
[[nodiscard]] level2::Volume echo_volume(const EchoVolumeSpec& spec,
                                         const std::function<EchoGate(const EchoPlace&)>& gate);

}  // namespace stormcellar::retrieve
