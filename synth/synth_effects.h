// synth/synth_effects.h -- instrument effects one at a time: noise, folding, clutter, jitter, loss.
//
// Units    dBZ, dB, m/s, metres, degrees, seconds. Minus infinity dBZ is no echo.
// Accuracy the formulas in double.
// Threads  all functions are pure; what is random comes from synth/counter_random.h.
#pragma once

#include <span>
#include <vector>

#include "synth/instrument.h"
#include "synth/vcp.h"

namespace stormcellar::synth {

// What a gate returns, each part weighted by its reflectivity in mm^6/m^3.
struct GateEcho {
    double dbz = 0;
    double away_mps = 0;
    double width_mps = 0;  // of the spectrum
};

// An estimate of the reflectivity from the power of echo and noise together, less the mean noise:
//   (S + N) exp(k g - k^2 / 2) - N,   k = noise_db ln(10) / 10,   g of mean 0 and deviation 1.
// So it is right in the mean of mm^6/m^3, its deviation is noise_db far above the noise and to
// first order noise_db (1 + N/S) (a power of M independent samples, less the noise, deviates by
// (1 + N/S) / sqrt(M); Doviak & Zrnic 1993, chapter 6). Without echo it is noise alone.
[[nodiscard]] double noisy_dbz(double dbz, double noise_level_dbz, double noise_db, double normal);

// The deviation of a velocity: velocity_noise_mps (1 + N/S). Estimators' formulas (there) have N/S
// and its square with coefficients that hang on the spectrum's width; this is both with one.
[[nodiscard]] double velocity_deviation_mps(double dbz, double noise_level_dbz,
                                            double velocity_noise_mps);

// What a velocity shows as: in [-nyquist, nyquist), a multiple of 2 nyquist off.
[[nodiscard]] double wrapped_mps(double velocity_mps, double nyquist_mps);

// Echo of several trips overlaid. `power` is each gate's, as Z over the range squared; gates of one
// radial, equally spaced. A gate is folded where its own power is less than `threshold_db` above
// the sum of those that arrive with it: all whole multiples of the unambiguous range away, to the
// nearest gate. Echo beyond the last gate does not come back.
[[nodiscard]] std::vector<bool> overlaid_gates(std::span<const double> power, double gates_a_trip,
                                               double threshold_db);

// Ground clutter in a beam:
//   peak - (peak - 10) range / range_m - 80 log10(2) (elevation / beam width)^2 + texture_db g
// with the elevation's part 0 for beams below the horizon: the two-way Gaussian pattern of a beam
// above it. g is of mean 0 and deviation 1 and belongs to the ground: half a degree by 250 m, the
// same in every cut and volume. Ends below -20 dBZ.
struct ClutterBeam {
    double azimuth_deg = 0;  // [0, 360)
    double elevation_deg = 0;
    double beam_width_deg = 0;
};
[[nodiscard]] double clutter_dbz(const Clutter& clutter, std::uint32_t seed,
                                 const ClutterBeam& beam, double range_m);
// None beyond this range, in any beam.
[[nodiscard]] double clutter_reach_m(const Clutter& clutter);
inline constexpr double clutter_width_mps = 0.3;  // of its spectrum, about 0 m/s

// Of two echoes: reflectivities add in mm^6/m^3, velocity and squared width are those of the sum of
// the two spectra.
[[nodiscard]] GateEcho sum_of(const GateEcho& a, const GateEcho& b);

// The antenna's deviation at a time after the start of its cut, at most 1 either way: the mean of
// three sines of 7.3, 3.1 and 1.7 seconds with phases of their own in each cut and volume.
struct Jitter {
    double azimuth = 0;
    double elevation = 0;
};
[[nodiscard]] Jitter jitter_at(std::uint32_t seed, int volume, int cut, double since_start_s);

// Whether a radial is lost. Cuts count from 1, radials from 0 in the order of the sweep.
struct RadialPlace {
    int volume = 0;
    int cut = 1;
    int radial = 0;
    double azimuth_deg = 0;  // [0, 360)
};
[[nodiscard]] bool is_missing(const Instrument& instrument, const RadialPlace& place);

}  // namespace stormcellar::synth
