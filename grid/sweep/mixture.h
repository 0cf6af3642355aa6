// grid/sweep/mixture.h -- the status rule, which decides the status and the value of a cell from
// several gates.
//
// The rule (docs/geometry.md): the gates of a cell have the total weights v (valued), n (no echo),
// f (range folded), a (ambiguous) and u (not seen). If u is over one half of the sum, the cell is
// not seen. Otherwise, if f + a is larger than both v and n, the cell is range folded or ambiguous,
// whichever weighs more. Otherwise, if v < n, the cell is no echo. Otherwise, the cell has a value.
// Range folded, ambiguous and unseen gates never enter a value; the other weights are scaled to 1.
// In reflectivity, gates without echo enter a value with their detection limits; in other moments
// they do not enter.
//
// Values that wrap (VEL at +-Nyquist, PHI at 360 degrees) are averaged on their circle. They enter
// the mean as differences from the value with the largest weight, the shorter way around. Values
// whose circles differ or are unknown cannot be averaged; the result is then the value with the
// largest weight.
//
// Threads   Plain values.
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

// Returns half the circle of a moment's values. Returns 0 if values do not wrap, or if the Nyquist
// velocity of the radial is unknown (0 or not finite).
[[nodiscard]] float half_period_of(level2::Moment moment, float nyquist_mps);

struct Sample {
    CellStatus status = CellStatus::not_seen;
    float value = 0;        // if the status is `value`
    float limit = 0;        // if the status is `no_echo`: its detection limit
    float half_period = 0;  // for values that wrap; 0: unknown
};

struct CellResult {
    CellStatus status = CellStatus::not_seen;
    float value = 0;
};

// Wraps a value into [-half_period, half_period).
[[nodiscard]] inline float wrap(float value, float half_period) {
    const float period = 2 * half_period;
    return value - period * std::floor((value + half_period) / period);
}

// Blends two samples. `weight_b` is the share of `b`, in [0, 1].
[[nodiscard]] CellResult blend(const Sample& a, const Sample& b, float weight_b, Blending blending);
// Returns the same as blend(). For callers that know at compile time whether the moment wraps;
// `circular` must equal is_circular(blending).
template <bool circular>
[[nodiscard]] CellResult blend_as(const Sample& a, const Sample& b, float weight_b,
                                  Blending blending);

// Sums the weights of any number of samples. For values that wrap, either add the sample with the
// largest weight first, or call refer_to() with a sample. Differences are then taken from the value
// of that sample.
class Mixture {
  public:
    [[nodiscard]] static Mixture of_unseen() {
        Mixture mixture;
        mixture.add_unseen(1);
        return mixture;
    }
    void refer_to(const Sample& sample) {
        reference_ = sample.value;
        half_period_ = sample.half_period;
    }
    void add(const Sample& sample, float weight, Blending blending) {
        is_circular(blending) ? add_as<true>(sample, weight, blending)
                              : add_as<false>(sample, weight, blending);
    }
    // Adds a sample. For callers that know at compile time whether the moment wraps; `circular`
    // must equal is_circular(blending).
    template <bool circular>
    void add_as(const Sample& sample, float weight, Blending blending);
    // Adds `count` samples of one status, each with weight 1. `sum` is the sum of their values or,
    // for no echo, of their limits. Not for values that wrap.
    void add_counted(CellStatus status, int count, float sum, Blending blending);
    // Adds all samples of another mixture. The weight of each is multiplied by `weight`.
    void add(const Mixture& other, float weight, Blending blending);
    void add_unseen(float weight) { unseen_ += weight; }

    [[nodiscard]] CellResult result(Blending blending) const {
        return is_circular(blending) ? result_as<true>(blending) : result_as<false>(blending);
    }
    template <bool circular>
    [[nodiscard]] CellResult result_as(Blending blending) const;
    [[nodiscard]] float weight() const { return valued_ + quiet_ + folded_ + ambiguous_ + unseen_; }
    [[nodiscard]] float unseen() const { return unseen_; }
    // Returns true if all samples are no echo, or all are not seen.
    [[nodiscard]] bool is_all_quiet() const {
        return valued_ + folded_ + ambiguous_ + unseen_ == 0;
    }
    [[nodiscard]] bool is_all_unseen() const {
        return valued_ + quiet_ + folded_ + ambiguous_ == 0;
    }

  private:
    void add_on_circle(float value, float half_period, float weight);

    float valued_ = 0, quiet_ = 0, folded_ = 0, ambiguous_ = 0, unseen_ = 0;
    float sum_ = 0;          // weight * value (limits too); circular: weight * difference
    float sum_weight_ = 0;   // the weight of the samples in sum_
    float reference_ = 0;    // circular: the value from which differences are taken
    float half_period_ = 0;  // circular: half of the circle
};

}  // namespace stormcellar::grid
