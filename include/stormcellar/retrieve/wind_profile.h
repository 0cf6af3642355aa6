// stormcellar/retrieve/wind_profile.h -- measures the wind above the radar, by height.
//
// Volume velocity processing (VVP): for each layer of height, a least-squares fit of one uniform
// wind to the unfolded velocities of all sweeps. A gate of azimuth a and elevation e sees
//     (u sin a + v cos a) cos e + w sin e
// with three parameters u, v and w, where w is the vertical velocity of the scatterers: the motion
// of the air and their fall in it. Gates that differ from the fit by more than three robust
// standard deviations are rejected, and the fit is repeated until the set of gates no longer
// changes. The first fit, by the least sum of absolute differences, leaves out velocities within 1
// m/s of zero, most of which are clutter.
//
// Units     m/s; u toward the east, v toward the north, w upward. Heights in meters ABOVE THE
//           ANTENNA; add antenna_position()->altitude_m for heights above sea level. Angles in
//           degrees clockwise from north.
// Source    The three-parameter VVP of Holleman (2005), who found it better than VAD and than VVP
//           with more parameters. Birds: Holleman et al. (2008), Dokter et al. (2011, 2019).
// Accuracy  u and v are within 0.25 m/s of uniform and sheared winds (5.6 m/s a kilometer) with
//           1 m/s of noise, folded at Nyquist velocities of 8 to 33 m/s and unfolded by
//           Dealiasing::anchored (tests/retrieve/wind_profile_test.cpp). The standard errors count
//           the gates of 5 degrees of azimuth as one measurement, because their errors are alike.
//           Not covered: wind that differs from place to place within reach, which shows in the
//           rms and the standard errors, and the bending of the beam (up to 0.3 degrees of e).
// Errors    See wind_profile(). A layer that cannot be fitted has a reason in place of numbers.
// Threads   Pure functions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/level2/volume.h"
#include "stormcellar/retrieve/dealias.h"

namespace stormcellar::retrieve {

// The reason why a layer has no wind.
enum class NoWind : std::uint8_t {
    no_echo,        // no gate within reach has a velocity
    no_nyquist,     // the file lacks the Nyquist velocity, so velocities cannot be unfolded (TDWR)
    too_few_gates,  // fewer than 30
    azimuth_gap,    // no gates in more than 120 degrees of azimuth
    clutter,        // most velocities are within 1 m/s of zero: ground clutter, or calm air
    scattered,      // the velocities fit no wind: noise, wrong folds, or very different winds
};
// Returns for example "too few gates".
[[nodiscard]] std::string_view text_of(NoWind reason);

// A horizontal velocity, of the air or of a storm.
struct Motion {
    double u_mps = 0, v_mps = 0;

    [[nodiscard]] double speed_mps() const;
    // Returns the direction that the motion comes FROM, in [0, 360); 0 for no motion.
    [[nodiscard]] double direction_deg() const;
};

// Signs of birds, whose flight adds about 9 m/s to the speed (Holleman et al. 2008).
enum class Birds : std::uint8_t {
    none,
    // Only with single polarization, up to 5 km above the antenna: an rms of at least 2 m/s
    // (Holleman et al. 2008, for C band). Winds that differ from place to place look the same.
    possible,
    // Only with dual polarization: an rms of at least 1 m/s (Dokter et al. 2019, for S band), and a
    // median correlation coefficient below 0.95 (Dokter et al. 2011, 2019). Insects, which drift
    // with the wind, have a smaller rms.
    likely,
};

struct LayerWind {
    Motion motion;
    std::optional<double> w_mps = std::nullopt;  // none if all beams are level
    double u_error_mps = 0, v_error_mps = 0;     // standard errors
    double rms_mps = 0;                          // of velocities about the fit, over the gates used
    std::size_t gates = 0, rejected_gates = 0;   // used and rejected
    double gap_deg = 0;  // the largest gap in azimuth, in steps of 5 degrees
    Birds birds = Birds::none;
};

struct WindLayer {
    double bottom_m = 0, top_m = 0;  // above the antenna
    tl::expected<LayerWind, NoWind> wind = tl::unexpected(NoWind::no_echo);

    [[nodiscard]] double middle_m() const { return (bottom_m + top_m) / 2; }
};

struct WindProfileOptions {
    double layer_m = 200;  // 50 to 2000
    double top_m = 12'000;
    // Slant ranges of the gates used. Near the radar there is ground clutter, and far away the wind
    // may differ.
    double least_range_m = 5'000;
    double most_range_m = 35'000;
};

// Returns the layers from the antenna upward. Uses the gates of all velocity moments whose fold
// number is certain. Errors: bad_argument if an option is out of range, or `dealiased` is not of
// this volume.
[[nodiscard]] Result<std::vector<WindLayer>> wind_profile(const level2::Volume& volume,
                                                          const Dealiased& dealiased,
                                                          const WindProfileOptions& options = {});

}  // namespace stormcellar::retrieve
