// stormcellar/retrieve/hydrometeors.h -- names the particles that make the echo of a gate: rain,
// snow, hail and others, from dual polarization.
//
// Method    Fuzzy logic. Each class has a trapezoid for each of six variables: reflectivity, ZDR,
//           the correlation coefficient (means of 3 radials x 1.25 km), the logarithm of KDP
//           (kdp.h), and the standard deviations of reflectivity (3 x 1.75 km) and differential
//           phase (3 x 2.25 km), which are root mean square differences of neighbors divided by the
//           root of 2. The class with the largest weighted mean of its trapezoids counts, if it is
//           at least 0.5. The height of the beam, with its half-power width of 0.95 degrees, over
//           the melting layer of its sector says which classes are possible, and hard limits rule
//           out others: retrieve/hydrometeors/memberships.cpp has the tables.
// Layer     That of melting_layer(). Without one, snow is assumed to melt over 500 m below a given
//           height of 0 C. The default is that of FreezingLevels (hail.h), which is wrong in winter
//           and in the tropics.
// Numbers   hydrometeor_number() gives those of product 165 of the National Weather Service.
// Accuracy  Of the gates of synthetic layers with noise, 99 % of rain, dry snow and wet snow get
//           their class, 93 % of graupel above a core of hail, 88 % of hail and 83 % of heavy rain.
//           The core is 10 km wide, and the gates with a wrong class are at its edges
//           (tests/retrieve/hydrometeors_test.cpp).
// Skill     Park et al. show one mesoscale system and give no score. Other authors report too much
//           hail and graupel from such rules.
// Not covered  Park et al. give each measurement a confidence; here all measurements count in full.
//           An error of ZDR, from calibration or attenuation, changes classes from about 0.3 dB on.
//           Sweeps without dual polarization get no classes. The size of hail, tornado debris,
//           other bands than S.
// Source    Park, Ryzhkov, Zrnic and Kim (2009), Wea. Forecasting 24, 730, sections 3 and 4. The
//           numbers of the tables were compared with those of another program.
// Threads   Pure functions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/level2/volume.h"
#include "stormcellar/retrieve/hail.h"
#include "stormcellar/retrieve/melting_layer.h"

namespace stormcellar::retrieve {

enum class Hydrometeor : std::uint8_t {
    none,  // no echo, no dual polarization, or no class fits
    biological,
    ground_clutter,
    ice_crystals,
    dry_snow,
    wet_snow,
    rain,
    heavy_rain,
    big_drops,
    graupel,
    hail,  // with or without rain
};
inline constexpr std::size_t hydrometeor_count = 11;

// Returns for example "big drops".
[[nodiscard]] std::string_view hydrometeor_name(Hydrometeor kind);

// Returns the value of the moment HCA: 10 for biological, 20 for ground clutter, up to 100 for
// hail.
[[nodiscard]] constexpr float hydrometeor_number(Hydrometeor kind) {
    return 10 * static_cast<float>(kind);
}
// Returns the class whose hydrometeor_number() this is; none for any other number.
[[nodiscard]] Hydrometeor hydrometeor_of_number(float number);

// The classes at the gates of one reflectivity moment.
struct SweepHydrometeors {
    std::size_t sweep = 0;             // index in the volume
    std::size_t moment = 0;            // index in the sweep
    std::vector<Hydrometeor> classes;  // radials x gate_stride
};

struct Hydrometeors {
    std::vector<SweepHydrometeors> sweeps;  // those with dual polarization
    // Heights of the layer in use, as "from 2280 to 2830 m above the antenna". If it was assumed,
    // the text also has the height of 0 C and the reason.
    std::string layer;
};

// A note for provenance begins with these words; `layer` follows.
inline constexpr std::string_view hydrometeor_words = "hydrometeor classes: melting layer ";

// Returns the height of 0 C above sea level, rounded to meters, that such a note assumed; none if
// no note assumed one.
[[nodiscard]] std::optional<double> assumed_zero_c_in_notes(std::span<const std::string> notes);

// Classifies all sweeps of a volume that have dual polarization. `zero_c_m` is above sea level; it
// counts only if the volume shows no melting layer.
[[nodiscard]] Hydrometeors hydrometeors(const level2::Volume& volume,
                                        double zero_c_m = FreezingLevels{}.zero_c_m);
// Uses a known layer.
[[nodiscard]] std::vector<SweepHydrometeors> hydrometeors(const level2::Volume& volume,
                                                          const MeltingLayer& layer);

}  // namespace stormcellar::retrieve
