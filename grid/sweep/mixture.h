// grid/sweep/mixture.h -- what gates hold, and what a cell holds that several of them make up: the
// status rule.
//
// DESIGN section 5: a cell has weights v (valued), n (no echo), f (folded) and u (not seen). u over
// one half: not seen; else f the largest: range folded; else v < n: no echo; else a value, into
// which no echo enters at its gate's detection limit for reflectivity and never for other moments.
// Folded and not seen never enter a value: the weights of the rest are scaled to 1.
// Moments that wrap (VEL on +-Nyquist, PHI on 360 degrees) are averaged on their circle: every
// value by the shorter way round from the one that weighs most. Values whose circles differ, or
// whose circle is not known, are not averaged: the one that weighs most stands.
// Threads: plain values.
#pragma once

#include <cmath>

#include "stormcellar/grid/grid.h"
#include "stormcellar/grid/method.h"
#include "stormcellar/level2/volume.h"

namespace stormcellar::grid {

enum class Blending {
    with_detection_limit,  // REF
    values_only,           // SW, ZDR, RHO, CFP
    nyquist_circle,        // VEL: from -Nyquist to Nyquist
    phase_circle,          // PHI: from 0 to 360
};
[[nodiscard]] inline bool is_circular(Blending blending) {
    return ChosenCircle::can_be(true) &&
           (blending == Blending::nyquist_circle || blending == Blending::phase_circle);
}
[[nodiscard]] Blending blending_of(level2::Moment moment);

// Half of the circle on which a moment's values lie; 0 where they do not wrap and where a radial's
// Nyquist velocity is not known (0 or not finite).
[[nodiscard]] float half_period_of(level2::Moment moment, float nyquist_mps);

// One gate.
struct Sample {
    CellStatus status = CellStatus::not_seen;
    float value = 0;  // where the status is value
    float limit = 0;  // where the status is no_echo: what the gate could have seen, as `value`
    float half_period = 0;  // of moments that wrap; 0: not known
};

struct CellResult {
    CellStatus status = CellStatus::not_seen;
    float value = 0;
};

// Onto [-half_period, half_period).
[[nodiscard]] inline float wrap(float value, float half_period) {
    const float period = 2 * half_period;
    return value - period * std::floor((value + half_period) / period);
}

// Of two samples, `weight_b` in [0, 1] being the second one's share.
[[nodiscard]] CellResult blend(const Sample& a, const Sample& b, float weight_b, Blending blending);
// The same where is_circular(blending) is known.
template <bool circular>
[[nodiscard]] CellResult blend_as(const Sample& a, const Sample& b, float weight_b,
                                  Blending blending);

// The weights of any number of samples. Where the moment wraps, add the one first that weighs most,
// or say whose circle and which value all others are taken from.
class Mixture {
  public:
    void refer_to(const Sample& sample) {
        reference_ = sample.value;
        half_period_ = sample.half_period;
    }
    void add(const Sample& sample, float weight, Blending blending) {
        is_circular(blending) ? add_as<true>(sample, weight, blending)
                              : add_as<false>(sample, weight, blending);
    }
    // The same where is_circular(blending) is known.
    template <bool circular>
    void add_as(const Sample& sample, float weight, Blending blending);
    // As if so many samples of a status were added, each with weight 1, whose values (or, of no
    // echo, limits) add up to `sum`. Not for moments that wrap.
    void add_counted(CellStatus status, int count, float sum, Blending blending);
    // As if all of its samples were added, each with `weight` times its own.
    void add(const Mixture& other, float weight, Blending blending);
    void add_unseen(float weight) { unseen_ += weight; }

    [[nodiscard]] CellResult result(Blending blending) const {
        return is_circular(blending) ? result_as<true>(blending) : result_as<false>(blending);
    }
    template <bool circular>
    [[nodiscard]] CellResult result_as(Blending blending) const;
    [[nodiscard]] float weight() const { return valued_ + quiet_ + folded_ + unseen_; }
    [[nodiscard]] float unseen() const { return unseen_; }
    // Nothing but no echo is in it, or nothing but not seen.
    [[nodiscard]] bool is_all_quiet() const { return valued_ + folded_ + unseen_ == 0; }
    [[nodiscard]] bool is_all_unseen() const { return valued_ + quiet_ + folded_ == 0; }

  private:
    void add_on_circle(float value, float half_period, float weight);

    float valued_ = 0, quiet_ = 0, folded_ = 0, unseen_ = 0;
    float sum_ = 0;          // of weight times value, limits included; circular: of differences
    float sum_weight_ = 0;   // of what is in sum_
    float reference_ = 0;    // circular: differences are from here
    float half_period_ = 0;  // circular
};

}  // namespace stormcellar::grid
