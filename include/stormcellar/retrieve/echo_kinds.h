// stormcellar/retrieve/echo_kinds.h -- names the kind of echo that is probably no weather.
//
// A gate gets the first kind of this list whose conditions it meets. A condition on a missing
// feature is not met, so gates without a velocity can be of few kinds only.
// retrieve/quality/echo_features.h has the size of the box of gates over which each feature is
// computed.
//
//   sun spike          a radial whose power is alike over at least 40 km, within 1.5 degrees of the
//                      sun (retrieve/quality/spokes.h)
//   interference       one to three radials full of echo for at least 60 km, with empty radials
//                      beside them
//   ground clutter     within 60 km and 2 km of height: speed up to 1 m/s with a texture up to 1.5
//                      m/s, spectrum width up to 2 m/s, texture of reflectivity at least 3 dB
//   distant ground     the same from 60 to 230 km, in the lowest sweeps, if the sweep above sees
//                      nothing there or at least 15 dB less. This is ground under anomalous
//                      propagation, or mountains: without terrain the two look alike.
//   birds and insects  up to 3 km above the antenna, echo in half of the gates around, texture of
//                      reflectivity up to 7 dB, a velocity in 70 % of these gates with a texture up
//                      to 5 m/s. With dual polarization also: up to 35 dBZ, a correlation below 0.9
//                      and a texture of PHI of at least 8 degrees. Without dual polarization: up to
//                      30 dBZ, echo and velocity in 80 % of the gates around, a spectrum width of
//                      at least 2 m/s, and a bloom: 10 to 60 km from the radar, at least 60 % of
//                      the gates from 0.2 to 1 km above it have echo, and at most 20 % of the gates
//                      from 3 to 6 km.
//   other              everything else
//
// Accuracy  tests/retrieve/echo_kinds_test.cpp: on synthetic volumes each kind is found in 90 % of
//           its gates. Rain and hail get a name in at most 1 % of their gates, even if all of them
//           count as probably no weather. In five real volumes, gates of at least 20 dBZ with a
//           correlation of at least 0.97 are certainly weather: 0.4 % of them get a name with dual
//           polarization, and 0.2 % without it. In the disk of birds of KLOT on October 19, 2020,
//           70 % of the gates are called birds and insects.
// Not covered  Sea clutter (needs a map of the water), wind turbines (needs several volumes, which
//           show that they do not move) and chaff (looks like birds) become `other`, or birds and
//           insects. Clutter that the radar's filter has removed in part has other velocities and
//           becomes `other`. Without dual polarization, shallow snow or drizzle with a wide
//           spectrum all around the radar can look like birds.
// Source    Ground: Kessinger et al. (2003), Steiner and Smith (2002). Birds: Dokter et al. (2011),
//           Stepanian et al. (2016). The numbers are our own.
// Threads   Pure functions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "stormcellar/level2/volume.h"
#include "stormcellar/retrieve/quality.h"

namespace stormcellar::retrieve {

enum class EchoKind : std::uint8_t {
    none,     // no echo, or the probability of weather is unknown
    weather,  // probability of weather at least the limit
    ground_clutter,
    distant_ground,
    sun_spike,
    interference,
    birds_and_insects,
    other,
};
inline constexpr std::size_t echo_kind_count = 8;

// Returns for example "birds and insects".
[[nodiscard]] std::string_view echo_kind_name(EchoKind kind);

// The kinds of the gates of one reflectivity moment.
struct SweepKinds {
    std::size_t sweep = 0;        // index in the volume
    std::size_t moment = 0;       // index in the sweep
    std::vector<EchoKind> kinds;  // radials x gate_stride
};

// Names the gates whose probability of weather is below `least`. `qualities` is the result of
// weather_probabilities() for the volume, with the same `only_single`. A sweep without dual
// polarization takes the kinds of the sweep that gave it its probabilities.
[[nodiscard]] std::vector<SweepKinds> echo_kinds(const level2::Volume& volume,
                                                 std::span<const SweepQuality> qualities,
                                                 double least = 0.5, bool only_single = false);

struct EchoShares {
    std::int64_t gates = 0;  // with echo and a probability
    std::array<std::int64_t, echo_kind_count> of_kind{};

    // Returns the share of a kind, 0 to 1; 0 if no gate has echo.
    [[nodiscard]] double share(EchoKind kind) const;
};
// Counts the gates of all sweeps.
[[nodiscard]] EchoShares echo_shares(std::span<const SweepKinds> sweeps);

}  // namespace stormcellar::retrieve
