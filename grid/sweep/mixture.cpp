#include "grid/sweep/mixture.h"

#include <algorithm>

#include "grid/cells/moment_rules.h"

namespace stormcellar::grid {

Blending blending_of(level2::Moment moment) {
    const level2::Circle circle = level2::facts_of(moment).circle;
    if (circle == level2::Circle::nyquist) return Blending::nyquist_circle;
    if (circle == level2::Circle::full_turn) return Blending::phase_circle;
    return rules_of(moment).has_detection_limit ? Blending::with_detection_limit
                                                : Blending::values_only;
}

float half_period_of(level2::Moment moment, float nyquist_mps) {
    const level2::Circle circle = level2::facts_of(moment).circle;
    if (circle == level2::Circle::full_turn) return 180;
    const bool is_known = std::isfinite(nyquist_mps) && nyquist_mps > 0;
    return circle == level2::Circle::nyquist && is_known ? nyquist_mps : 0;
}

// Adds a value as its difference from the reference, the shorter way around. Without refer_to(),
// the first value is the reference, so the caller must add the value with the largest weight first.
// Leaves out a value that is on another circle.
void Mixture::add_on_circle(float value, float half_period, float weight) {
    const bool is_first = sum_weight_ == 0 && !(half_period_ > 0);
    if (is_first) {
        reference_ = value;
        half_period_ = half_period;
        sum_weight_ = weight;
        return;
    }
    if (half_period != half_period_ || !(half_period > 0)) return;
    sum_ += weight * wrap(value - reference_, half_period);
    sum_weight_ += weight;
}

template <bool circular>
void Mixture::add_as(const Sample& sample, float weight, Blending blending) {
    switch (sample.status) {
        case CellStatus::value:
            valued_ += weight;
            if (circular) {
                add_on_circle(sample.value, sample.half_period, weight);
            } else {
                sum_ += weight * sample.value;
                sum_weight_ += weight;
            }
            return;
        case CellStatus::no_echo:
            quiet_ += weight;
            if (blending == Blending::with_detection_limit) {
                sum_ += weight * sample.limit;
                sum_weight_ += weight;
            }
            return;
        case CellStatus::range_folded:
            folded_ += weight;
            return;
        case CellStatus::ambiguous:
            ambiguous_ += weight;
            return;
        case CellStatus::not_seen:
            unseen_ += weight;
            return;
    }
}

template void Mixture::add_as<false>(const Sample&, float, Blending);
template void Mixture::add_as<true>(const Sample&, float, Blending);

void Mixture::add_counted(CellStatus status, int count, float sum, Blending blending) {
    const auto weight = static_cast<float>(count);
    add_as<false>({status, 0, 0, 0}, weight, blending);
    const bool has_sum =
        status == CellStatus::value ||
        (status == CellStatus::no_echo && blending == Blending::with_detection_limit);
    if (has_sum) sum_ += sum;
}

void Mixture::add(const Mixture& other, float weight, Blending blending) {
    valued_ += weight * other.valued_;
    quiet_ += weight * other.quiet_;
    folded_ += weight * other.folded_;
    ambiguous_ += weight * other.ambiguous_;
    unseen_ += weight * other.unseen_;
    if (is_circular(blending)) {
        if (other.sum_weight_ == 0) return;
        const float mean = other.reference_ + other.sum_ / other.sum_weight_;
        add_on_circle(mean, other.half_period_, weight * other.sum_weight_);
        return;
    }
    sum_ += weight * other.sum_;
    sum_weight_ += weight * other.sum_weight_;
}

template <bool circular>
CellResult Mixture::result_as(Blending blending) const {
    const float unknown = folded_ + ambiguous_;
    const float seen = valued_ + quiet_ + unknown;
    if (unseen_ > seen || seen == 0) return {CellStatus::not_seen, 0};
    if (unknown > valued_ && unknown > quiet_)
        return {folded_ >= ambiguous_ ? CellStatus::range_folded : CellStatus::ambiguous, 0};
    if (valued_ < quiet_) return {CellStatus::no_echo, 0};
    const float mean = reference_ + sum_ / sum_weight_;
    if (!circular || !(half_period_ > 0)) return {CellStatus::value, mean};
    const float middle = blending == Blending::phase_circle ? half_period_ : 0;
    return {CellStatus::value, middle + wrap(mean - middle, half_period_)};
}

template CellResult Mixture::result_as<false>(Blending) const;
template CellResult Mixture::result_as<true>(Blending) const;

template <bool circular>
CellResult blend_as(const Sample& a, const Sample& b, float weight_b, Blending blending) {
    const float weight_a = 1 - weight_b;
    if (a.status == b.status && a.status != CellStatus::value) return {a.status, 0};
    if (a.status == b.status && !circular) {
        return {CellStatus::value, weight_a * a.value + weight_b * b.value};
    }
    Mixture mixture;
    const bool b_first = weight_b > weight_a;
    mixture.add_as<circular>(b_first ? b : a, b_first ? weight_b : weight_a, blending);
    mixture.add_as<circular>(b_first ? a : b, b_first ? weight_a : weight_b, blending);
    return mixture.result_as<circular>(blending);
}

template CellResult blend_as<false>(const Sample&, const Sample&, float, Blending);
template CellResult blend_as<true>(const Sample&, const Sample&, float, Blending);

CellResult blend(const Sample& a, const Sample& b, float weight_b, Blending blending) {
    return is_circular(blending) ? blend_as<true>(a, b, weight_b, blending)
                                 : blend_as<false>(a, b, weight_b, blending);
}

}  // namespace stormcellar::grid
