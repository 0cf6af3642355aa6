// stormcellar/retrieve/dealias.h -- finds which velocities are folded, and how often.
//
// A Doppler radar measures velocity modulo twice the Nyquist velocity. The true velocity of a gate
// is raw + 2 n Nyquist, where the fold number n is whole. dealias() finds n. Values are never
// smoothed, replaced or invented.
//
// Rungs     The methods, the simplest first:
//           profile   takes the fold number that brings a gate nearest to the wind at its height
//           region    joins gates of similar velocity into regions, and unfolds the regions so that
//                     neighboring gates agree as well as they can. The mean fold number of a
//                     sweep's main echo is near 0; smaller echo that is not joined to it is
//                     ambiguous.
//           anchored  unfolds the regions so that they also agree with the wind at their height and
//                     with the sweeps above and below
// Units     m/s; fold numbers.
// Source    Regions: Helmus and Collis (2016). The exact minimum over all regions: Bioucas-Dias and
//           Valadao (2007). The weights of jumps, the anchors and the repair are our own.
// Accuracy  The rung `anchored` is right at 99.9 % of the gates of uniform, sheared and rotating
//           winds with 1 m/s of noise, for Nyquist velocities from 8 to 33 m/s
//           (tests/retrieve/dealias_test.cpp). In noisy data the search may stop before the best
//           solution. `ambiguous` marks about a third of the wrong gates. Each sweep of a volume
//           may be dealiased alone, with the sweeps before it as `known`. Then at most 0.1 % of the
//           gates get another velocity than in the whole volume, and 0.5 % another mark
//           (tests/retrieve/known_sweeps_test.cpp).
// Errors    See dealiasing_from_name() and add_dealiased_velocity(). dealias() returns no errors:
//           the fold number is 0 for gates without a value, for radials whose Nyquist velocity is
//           missing (TDWR) or not from 1 to 200 m/s, and where `profile` has no wind.
// Threads   Pure functions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::retrieve {

// `automatic` is `anchored` if needs_dealiasing() returns true. Otherwise it is `off`, but marks
// gates of radials without a usable Nyquist velocity as ambiguous.
enum class Dealiasing : std::uint8_t { off, profile, region, anchored, automatic };

// The words of options: off, profile, region, anchored, auto.
[[nodiscard]] std::string_view dealiasing_name(Dealiasing rung);
[[nodiscard]] std::string dealiasing_names();  // "off, auto, profile, region or anchored"
// Errors: bad_argument, with the list of words.
[[nodiscard]] Result<Dealiasing> dealiasing_from_name(std::string_view name);

// Fold numbers of one moment of one sweep.
struct SweepFolds {
    std::size_t sweep = 0;   // index in the volume
    std::size_t moment = 0;  // index in the sweep
    // Rows as in the moment: radials x gate_stride.
    std::vector<std::int8_t> folds;
    // 1 where the fold number is uncertain, because another number would fit nearly as well,
    // because neighboring gates differ too much, or because the radial has no usable Nyquist
    // velocity.
    std::vector<std::uint8_t> ambiguous;
};

struct Dealiased {
    std::vector<SweepFolds> sweeps;  // of all velocity moments, in the order of the volume
    // Number of pairs of adjacent gates, and of pairs whose received velocities differ by more than
    // the Nyquist velocity. Pairs inside a run (regions.h) do not count. The rung `profile` counts
    // no pairs.
    std::int64_t pairs = 0, jumps = 0;
    std::int64_t gates = 0, folded_gates = 0, ambiguous_gates = 0;
    Dealiasing rung = Dealiasing::off;  // the rung that was used, never `automatic`
};

// Finds the fold numbers of all velocity moments. With Dealiasing::off, all fold numbers are 0.
//
// The rung `anchored` also uses the VELD of `known`: sweeps of the same radar that were dealiased
// before, at most 15 minutes older or newer. The known sweeps are of the volume before, or of the
// same volume if it still grows. They vote as the sweeps above and below do, and they unfold
// isolated echo if they show this echo joined to other echo. needs_dealiasing() ignores the known
// sweeps.
[[nodiscard]] Dealiased dealias(const level2::Volume& volume, Dealiasing rung,
                                std::span<const level2::Sweep> known = {});

// Returns true if more than one in ten thousand pairs of adjacent gates differ by more than the
// Nyquist velocity. A volume that needs no dealiasing by this test may still have isolated echo
// that is folded as a whole.
[[nodiscard]] bool needs_dealiasing(const level2::Volume& volume);

// Adds the moment VELD after each velocity moment, with the same rows: raw + 2 n Nyquist, and the
// flags of VEL. A gate is ambiguous if its fold number is uncertain, if its radial has no Nyquist
// velocity, or if its velocity would exceed 320 m/s. Replaces VELD if the volume has it.
// Errors: not_found if the volume has no velocities.
[[nodiscard]] Result<Dealiased> add_dealiased_velocity(level2::Volume& volume, Dealiasing rung,
                                                       std::span<const level2::Sweep> known = {});

}  // namespace stormcellar::retrieve
