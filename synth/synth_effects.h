// synth/synth_effects.h -- computes the effects of the instrument one at a time: noise, folding,
// clutter, jitter, loss.
//
// Units     dBZ, dB, m/s, meters, degrees, seconds. Minus infinity dBZ means no echo.
// Accuracy  The formulas in double.
// Threads   Pure functions. Random numbers come from synth/counter_random.h.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "synth/counter_random.h"
#include "synth/instrument.h"
#include "synth/vcp.h"

namespace stormcellar::synth {

// The echo of a gate. Each part is weighted by its reflectivity in mm^6/m^3.
struct GateEcho {
    double dbz = 0;
    double away_mps = 0;
    double width_mps = 0;  // of the spectrum
};

// Returns an estimate of the reflectivity: the power of echo and noise together, less the mean
// noise:
//   (S + N) exp(k g - k^2 / 2) - N,   k = noise_db ln(10) / 10,   g with mean 0 and deviation 1.
// So the mean is right in mm^6/m^3. The deviation is noise_db far above the noise, and noise_db (1
// + N/S) to first order elsewhere. (The power of M independent samples, less the noise, has the
// deviation (1 + N/S) / sqrt(M); Doviak & Zrnic 1993, chapter 6.) Without echo, the estimate is
// noise alone.
[[nodiscard]] double noisy_dbz(double dbz, double noise_level_dbz, double noise_db, double normal);

// Returns the deviation of a velocity: velocity_noise_mps (1 + N/S). In the formulas of real
// estimators (same source), N/S and its square have coefficients that depend on the width of the
// spectrum. Here these coefficients are 1.
[[nodiscard]] double velocity_deviation_mps(double dbz, double noise_level_dbz,
                                            double velocity_noise_mps);

// Returns the aliased velocity, which is in [-nyquist, nyquist) and off by a multiple of 2 nyquist.
[[nodiscard]] double wrapped_mps(double velocity_mps, double nyquist_mps);

// Returns the fold number: the whole number n for which shown + 2 n nyquist is nearest to the true
// velocity. Noise below the Nyquist velocity does not change n.
[[nodiscard]] int fold_number(double true_mps, double shown_mps, double nyquist_mps);

// Returns which gates of a radial are folded because echo of several trips overlaps. Gates are
// equally spaced; `power` is Z over the square of the range. A gate is folded if its own power is
// less than `threshold_db` above the sum of the powers that arrive with it. These powers come from
// all gates that are a whole multiple of the unambiguous range away, rounded to the nearest gate.
// Echo beyond the last gate does not come back.
[[nodiscard]] std::vector<bool> overlaid_gates(std::span<const double> power, double gates_a_trip,
                                               double threshold_db);

// Ground clutter in a beam:
//   peak - (peak - 10) range / range_m - 80 log10(2) (elevation / beam width)^2 + texture_db g
// The term with the elevation is the two-way Gaussian pattern of a beam above the horizon. This
// term is 0 for beams below the horizon. g has mean 0 and deviation 1 and belongs to the ground: it
// changes every half degree and 250 m, but is the same in every cut and volume. Clutter ends below
// -20 dBZ.
struct ClutterBeam {
    double azimuth_deg = 0;  // [0, 360)
    double elevation_deg = 0;
    double beam_width_deg = 0;
};
[[nodiscard]] double clutter_dbz(const Clutter& clutter, std::uint32_t seed,
                                 const ClutterBeam& beam, double range_m);
// Returns the range beyond which no beam has clutter.
[[nodiscard]] double clutter_reach_m(const Clutter& clutter);
inline constexpr double clutter_width_mps = 0.3;  // of its spectrum, around 0 m/s

// Returns the sum of two echoes. Reflectivities are added in mm^6/m^3; velocity and width are those
// of the sum of the two spectra.
[[nodiscard]] GateEcho sum_of(const GateEcho& a, const GateEcho& b);

// The antenna's deviation at a time after the start of its cut, in [-1, 1]. The deviation is the
// mean of three sines with periods of 7.3, 3.1 and 1.7 seconds, whose phases differ from cut to cut
// and from volume to volume.
struct Jitter {
    double azimuth = 0;
    double elevation = 0;
};
[[nodiscard]] Jitter jitter_at(std::uint32_t seed, int volume, int cut, double since_start_s);

// The place of a radial that may be lost. Cuts are counted from 1, radials from 0, in the order of
// the sweep.
struct RadialPlace {
    int volume = 0;
    int cut = 1;
    int radial = 0;
    double azimuth_deg = 0;  // [0, 360)
};
[[nodiscard]] bool is_missing(const Instrument& instrument, const RadialPlace& place);

// Returns true if the gate at `place` is lost.
[[nodiscard]] bool is_missing_gate(const Instrument& instrument, const DrawPlace& place);

// Returns the speckle of a gate without echo, if the gate has any. The speckle is 0 to 10 dB above
// the limit of detection, with a velocity anywhere between -nyquist and nyquist, and the width of
// noise.
[[nodiscard]] std::optional<GateEcho> speckle_at(const Instrument& instrument,
                                                 const DrawPlace& place, double limit_dbz,
                                                 double nyquist_mps);

// Returns the deviation of velocities that are spread evenly over the Nyquist interval, as in
// noise.
[[nodiscard]] double noise_width_mps(double nyquist_mps);

}  // namespace stormcellar::synth
