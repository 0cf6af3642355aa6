#include "grid/fill/mixed_column.h"

#include <algorithm>
#include <cmath>

#include "grid/beam/beam_pattern.h"
#include "grid/fill/beam_choice.h"

namespace stormcellar::grid {
namespace {

constexpr int quarters = 4;

Mixture of_one(const BeamMixture& beam, Blending blending) {
    Mixture mixture;
    mixture.add(beam.mixture, 1, blending);
    return mixture;
}

// The beams [first, end). No lost cut is between them.
struct Run {
    std::size_t first, end;
};
Run run_around(std::span<const BeamMixture> beams, std::size_t at) {
    Run run{at, at + 1};
    while (run.first > 0 && beams[run.first - 1].adjacent_to_next)
        --run.first;
    while (run.end < beams.size() && beams[run.end - 1].adjacent_to_next)
        ++run.end;
    return run;
}

float rise_of(const BeamMixture& beam) {
    return std::max(beam.rise_m_per_deg, 1e-3F);
}

}  // namespace

std::vector<float> heights_of_levels(std::span<const float> levels_m, CellExtent cell) {
    if (cell == CellExtent::point || levels_m.size() < 2) {
        return {levels_m.begin(), levels_m.end()};
    }
    std::vector<float> heights_m;
    const std::size_t last = levels_m.size() - 1;
    for (std::size_t level = 0; level <= last; ++level) {
        const float down =
            level > 0 ? levels_m[level] - levels_m[level - 1] : levels_m[1] - levels_m[0];
        const float up = level < last ? levels_m[level + 1] - levels_m[level]
                                      : levels_m[last] - levels_m[last - 1];
        const float bottom = levels_m[level] - down / 2;
        const float quarter = (down + up) / 2 / quarters;
        for (int i = 0; i < quarters; ++i)
            heights_m.push_back(bottom + (static_cast<float>(i) + 0.5F) * quarter);
    }
    return heights_m;
}

void MixedColumn::start(std::span<const BeamMixture> beams) {
    beams_ = beams;
    above_ = 0;
    steepest_m_per_deg_ = 0;
    for (const BeamMixture& beam : beams)
        steepest_m_per_deg_ = std::max(steepest_m_per_deg_, rise_of(beam));
}

// Finds the beam above a height. Heights rise from call to call, so the search takes a step or two.
void MixedColumn::find(float height_m) {
    while (above_ > 0 && beams_[above_ - 1].height_m > height_m)
        --above_;
    while (above_ < beams_.size() && beams_[above_].height_m <= height_m)
        ++above_;
}

// Mixes all beams within reach of a height, weighted by the antenna's pattern. `nearest` is the
// beam that would count if only one counted.
Mixture MixedColumn::by_pattern(std::size_t nearest, float height_m, float width_deg) {
    const auto weight_of = [&](const BeamMixture& beam) {
        return beam_pattern((height_m - beam.height_m) / rise_of(beam), width_deg);
    };
    const float reach_m = reach_m_of(width_deg);
    // Only beams of the same run count, and of these only beams that are within reach.
    Run run = run_around(beams_, nearest);
    while (run.first < nearest && beams_[run.first].height_m < height_m - reach_m)
        ++run.first;
    while (run.end > nearest + 1 && beams_[run.end - 1].height_m > height_m + reach_m)
        --run.end;
    weights_.clear();
    float total = 0;
    for (std::size_t at = run.first; at < run.end; ++at) {
        weights_.push_back(weight_of(beams_[at]));
        total += weights_.back();
    }
    if (!(total > 0)) return of_one(beams_[nearest], blending_);
    // For values that wrap, the beam that is added first is the reference, so it must have the
    // largest weight. This beam is usually the nearest beam. If neighbors are far apart and rise
    // differently, the nearest beam may be out of reach; then the first beam that has a weight is
    // the reference.
    std::size_t first = nearest;
    if (!(weights_[nearest - run.first] > 0)) {
        const auto heavy =
            std::find_if(weights_.begin(), weights_.end(), [](float weight) { return weight > 0; });
        first = run.first + static_cast<std::size_t>(heavy - weights_.begin());
    }
    Mixture mixture;
    mixture.add(beams_[first].mixture, weights_[first - run.first] / total, blending_);
    for (std::size_t at = run.first; at < run.end; ++at) {
        const float weight = at == first ? 0 : weights_[at - run.first];
        if (weight > 0) mixture.add(beams_[at].mixture, weight / total, blending_);
    }
    return mixture;
}

// Returns the width of the pattern with which the two beams around the height always count.
float MixedColumn::width_between_deg() const {
    const BeamMixture& low = beams_[above_ - 1];
    const BeamMixture& high = beams_[above_];
    const float mean_rise = std::max(1e-3F, (low.rise_m_per_deg + high.rise_m_per_deg) / 2);
    return std::max(beam_width_deg_, (high.height_m - low.height_m) / mean_rise);
}

// Returns true if all beams that may count at a height have no echo. Then the cell has no echo, and
// nothing need be mixed.
bool MixedColumn::is_quiet_around(float height_m) const {
    const bool by_pattern = interpolation_ == Interpolation::beam_weighted;
    const float reach_m = by_pattern ? reach_m_of(width_between_deg()) : 0;
    std::size_t below = above_;
    do {
        if (!beams_[--below].mixture.is_all_quiet()) return false;
    } while (below > 0 && beams_[below - 1].height_m >= height_m - reach_m);
    std::size_t above = above_;
    do {
        if (!beams_[above++].mixture.is_all_quiet()) return false;
    } while (above < beams_.size() && beams_[above].height_m <= height_m + reach_m);
    return true;
}

// Mixes two adjacent beams. Adds the beam with the larger weight first, because the first is the
// reference for values that wrap.
Mixture MixedColumn::between(float height_m) {
    const BeamMixture& low = beams_[above_ - 1];
    const BeamMixture& high = beams_[above_];
    const float span_m = high.height_m - low.height_m;
    const float weight = (height_m - low.height_m) / span_m;
    const bool high_first = weight > 0.5F;
    if (interpolation_ == Interpolation::beam_weighted) {
        return by_pattern(high_first ? above_ : above_ - 1, height_m, width_between_deg());
    }
    if (interpolation_ == Interpolation::nearest) return of_one(high_first ? high : low, blending_);
    Mixture mixture;
    const BeamMixture& first = high_first ? high : low;
    const BeamMixture& second = high_first ? low : high;
    const float second_weight = high_first ? 1 - weight : weight;
    mixture.add(first.mixture, 1 - second_weight, blending_);
    mixture.add(second.mixture, second_weight, blending_);
    return mixture;
}

// Returns the mixture at a height that is not between adjacent beams. The mixture takes the nearer
// beam whose edges enclose the height; for beam_weighted, it also takes the neighbors of this beam
// that are within reach.
Mixture MixedColumn::outside(float height_m) {
    const BeamMixture* const below = above_ > 0 ? &beams_[above_ - 1] : nullptr;
    const BeamMixture* const above = above_ < beams_.size() ? &beams_[above_] : nullptr;
    const BeamMixture* const alone = beam_alone(below, above, height_m);
    if (alone == nullptr) return Mixture::of_unseen();
    const std::size_t nearest = alone == below ? above_ - 1 : above_;
    if (interpolation_ == Interpolation::beam_weighted)
        return by_pattern(nearest, height_m, beam_width_deg_);
    return of_one(beams_[nearest], blending_);
}

Mixture MixedColumn::at(float height_m) {
    find(height_m);
    return is_between_adjacent() ? between(height_m) : outside(height_m);
}

// Returns true if no beam and no edge of a beam is between the two heights. Call find(lowest_m)
// before it.
bool MixedColumn::are_outside(float lowest_m, float highest_m) const {
    if (is_between_adjacent()) return false;
    const bool clear_below = above_ == 0 || lowest_m > beams_[above_ - 1].upper_edge_m;
    const bool clear_above = above_ == beams_.size() || (highest_m < beams_[above_].lower_edge_m &&
                                                         highest_m < beams_[above_].height_m);
    return clear_below && clear_above;
}

// Returns the mean over the heights of a cell with an extent. Between two beams, shares are linear
// in height, so the mean over several heights equals the mixture in their middle.
CellResult MixedColumn::mean_at(std::span<const float> heights_m) {
    const float lowest_m = heights_m.front();
    const float highest_m = heights_m.back();
    find(lowest_m);
    if (are_outside(lowest_m, highest_m)) return {CellStatus::not_seen, 0};
    const bool linear = interpolation_ != Interpolation::nearest &&
                        interpolation_ != Interpolation::beam_weighted && !is_circular(blending_);
    if (linear && is_between_adjacent() && highest_m < beams_[above_].height_m) {
        if (is_quiet_around(lowest_m)) return {CellStatus::no_echo, 0};
        return between((lowest_m + highest_m) / 2).result(blending_);
    }
    Mixture mean;
    for (const float height_m : heights_m)
        mean.add(at(height_m), 1 / static_cast<float>(heights_m.size()), blending_);
    return mean.result(blending_);
}

CellResult MixedColumn::cell_at(float height_m) {
    find(height_m);
    if (!is_between_adjacent()) return outside(height_m).result(blending_);
    if (is_quiet_around(height_m)) return {CellStatus::no_echo, 0};
    return between(height_m).result(blending_);
}

}  // namespace stormcellar::grid
