// retrieve/judge/refold.h -- folds velocities again at a lower Nyquist velocity, and counts the
// fold numbers that a rung gets wrong.
//
// So real volumes can test dealias(). Fold numbers that are certain at the real Nyquist velocity
// give the true velocity of each gate. At a lower Nyquist velocity, the same gates are folded more
// often, so that their fold numbers are harder to find.
//
// Units     m/s; fold numbers.
// Accuracy  Velocities are rounded to 0.01 m/s, in which radars send the Nyquist velocity
//           (tests/retrieve/refold_test.cpp).
// Errors    See refold().
// Threads   Pure functions.
// Not covered  Noise, gaps and beams stay those of the real Nyquist velocity. A truth that one rung
//           gave favors this rung.
#pragma once

#include <cstdint>
#include <vector>

#include "stormcellar/base/result.h"
#include "stormcellar/level2/volume.h"
#include "stormcellar/retrieve/dealias.h"

namespace stormcellar::retrieve {

// Velocities and their true fold numbers, for all velocity moments in the order of the volume. In
// `folds`, `ambiguous` marks the gates whose true fold number is unknown.
struct KnownVolume {
    level2::Volume volume;
    std::vector<SweepFolds> folds;
};

// Folds the velocity raw + 2 n Nyquist of every gate again, so that it is between -`nyquist_mps`
// and `nyquist_mps`. Gates whose fold number is unknown are folded again, too, and remain unknown.
// Radials whose Nyquist velocity is the same keep velocities and fold numbers. Radials whose
// Nyquist velocity is lower or missing keep velocities, and their fold numbers become unknown.
// Returns bad_argument unless `nyquist_mps` is from 1 to 200 and `known` has the fold numbers of
// every velocity moment.
[[nodiscard]] Result<KnownVolume> refold(const KnownVolume& known, double nyquist_mps);

struct FoldScore {
    std::int64_t gates = 0, ambiguous = 0;  // gates with a velocity, and those marked ambiguous
    std::int64_t known = 0, wrong = 0;      // gates whose true fold number is known
    std::int64_t known_unmarked = 0, wrong_unmarked = 0;  // the same, without marked gates

    // Shares from 0 to 1; 0 if there is no gate.
    [[nodiscard]] double wrong_share() const;
    [[nodiscard]] double ambiguous_share() const;
    [[nodiscard]] double wrong_unmarked_share() const;
};

// Compares the result of dealias() for `known.volume` with the true fold numbers.
[[nodiscard]] FoldScore score_folds(const KnownVolume& known, const Dealiased& found);

// Counts the pairs of adjacent gates whose unfolded velocities differ by more than the Nyquist
// velocity. The last radial of a sweep is beside the first.
[[nodiscard]] std::int64_t count_jumps(const level2::Volume& volume, const Dealiased& found);

}  // namespace stormcellar::retrieve
