#include "retrieve/kdp/phase_slope.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace stormcellar::retrieve {
namespace {

constexpr std::array window_lengths_m = {1750.0, 2250.0,  3250.0,  4750.0,
                                         7250.0, 10250.0, 14250.0, 20250.0};
constexpr float confidence = 2.3F;  // standard errors of the intervals that must intersect
// A gate takes windows of which 0, 1, ... or 8 eighths are before the gate. Windows that reach to
// both sides count in full, because a slope that changes evenly does not bias them.
constexpr int window_parts = 8;
constexpr float weight_aside = 0.1F;
constexpr double least_good_share = 0.6;
constexpr double least_good_gates = 5;
constexpr double noise_reach_m = 3000;
constexpr double most_line_noise = 1.5;  // residuals of a line in noise

constexpr std::array backscatter_lengths_m = {1250.0, 2250.0, 3250.0};
constexpr double flank_m = 2500;
constexpr double least_backscatter_deg = 2;
constexpr double backscatter_significance = 5;  // standard errors
constexpr double most_flank_noise = 1.5;        // residuals in noise
constexpr float no_slope = std::numeric_limits<float>::quiet_NaN();

int gates_in(double length_m, double spacing_m) {
    return static_cast<int>(std::clamp(std::lround(length_m / spacing_m), 1L, 400L));
}

bool is_backscatter(const RowSums& sums, std::ptrdiff_t begin, int gates, int flank,
                    double noise_deg) {
    const std::ptrdiff_t end = begin + gates;
    if (sums.count(begin, end) < least_good_share * gates ||
        sums.count(begin - flank, begin) < least_good_share * flank ||
        sums.count(end, end + flank) < least_good_share * flank)
        return false;
    const LineSums inside = sums.between(begin, end);
    const LineSums left = sums.between(begin - flank, begin);
    const LineSums right = sums.between(end, end + flank);
    const LineSums beside = left + right;
    const auto line = line_of(beside);
    if (!line) return false;
    const double x = inside.x / inside.n;
    const double deviation = std::abs(inside.y / inside.n - line->y - line->slope * (x - line->x));
    // Most calls end here, before the lines of the flanks are fitted.
    if (deviation < least_backscatter_deg ||
        residual_deg(beside, *line) > most_flank_noise * noise_deg)
        return false;
    const auto before = line_of(left), after = line_of(right);
    if (!before || !after) return false;
    const double variance =
        1 / inside.n + 1 / line->n + (x - line->x) * (x - line->x) / line->spread;
    // A bend of the phase also deviates from the line. The slopes of the flanks give a bound of
    // this deviation.
    const double bend = std::abs(after->slope - before->slope) +
                        2 * noise_deg * std::sqrt(1 / before->spread + 1 / after->spread);
    const double most_of_bend = bend * (after->x - before->x) / 8;
    return deviation >=
           std::max(2 * most_of_bend, backscatter_significance * noise_deg * std::sqrt(variance));
}

}  // namespace

SlopeFitter::SlopeFitter(double spacing_m)
    : spacing_m_(spacing_m), reach_(gates_in(window_lengths_m.back(), spacing_m)) {
    for (const double length_m : window_lengths_m)
        lengths_.emplace_back().gates = gates_in(length_m, spacing_m);
}

// Marks gates with backscatter phase as not good. These are up to 3 km of gates that deviate from a
// line that fits the gates on both sides. Returns true if there are any.
bool SlopeFitter::leave_out_backscatter(PhaseRow& row) const {
    const int flank = gates_in(flank_m, spacing_m_);
    std::vector<std::uint8_t> is_good = row.is_good;
    const auto gates_in_row = static_cast<std::ptrdiff_t>(row.is_good.size());
    bool has_left_out = false;
    for (const double length_m : backscatter_lengths_m) {
        const int gates = gates_in(length_m, spacing_m_);
        for (std::ptrdiff_t begin = flank; begin + gates + flank <= gates_in_row; ++begin) {
            const auto middle = static_cast<std::size_t>(begin + gates / 2);
            if (row.is_good[middle] == 0 ||
                !is_backscatter(sums_, begin, gates, flank, noise_deg_[middle]))
                continue;
            std::fill_n(is_good.begin() + begin, gates, std::uint8_t{0});
            has_left_out = true;
        }
    }
    row.is_good = std::move(is_good);
    return has_left_out;
}

void SlopeFitter::read(const PhaseRow& row) {
    sums_.read(row, reach_);
    noise_deg_ = phase_noise_deg(row, gates_in(noise_reach_m, spacing_m_));
}

const PhaseSlopes& SlopeFitter::fit(PhaseRow& row) {
    const std::size_t gates = row.phases_deg.size();
    slopes_.deg_per_gate.assign(gates, no_slope);
    slopes_.error.assign(gates, no_slope);
    const auto good = std::ranges::count(row.is_good, std::uint8_t{1});
    if (static_cast<double>(good) < least_good_gates) return slopes_;
    read(row);
    if (leave_out_backscatter(row)) read(row);
    extend_noise();
    for (WindowSlopes& windows : lengths_) {
        const double least = least_good_share * static_cast<double>(windows.gates);
        fit_windows(sums_, noise_deg_, static_cast<std::size_t>(reach_),
                    {confidence, std::max(least_good_gates, least), most_line_noise}, windows);
    }
    means_.begin(lengths_.back(), window_parts, gates);
    for (std::ptrdiff_t part = 0; part <= window_parts; ++part)
        add_windows(lengths_, part, window_parts, 2 * part == window_parts ? 1 : weight_aside,
                    gates, means_);
    for (std::size_t gate = 0; gate < gates; ++gate) {
        const float weights = means_.weights[gate];
        if (row.has_phase[gate] == 0 || !(weights > 0)) continue;
        const float slope = means_.slopes[gate] / weights;
        slopes_.deg_per_gate[gate] = slope;
        // The windows share their gates, so the error is the mean of their errors. Where the phase
        // is even, long windows weigh most. Their errors may not show a slow change of the slope.
        const float error = means_.errors[gate] / weights;
        const float variance = std::max(0.0F, means_.squares[gate] / weights - slope * slope);
        const bool is_even = means_.is_even[gate] > 0;
        slopes_.error[gate] = is_even ? std::sqrt(error * error + variance / 4) : error;
    }
    return slopes_;
}

// Repeats the noise of the first gate before the row, and the noise of the last gate behind it.
void SlopeFitter::extend_noise() {
    const auto reach = static_cast<std::size_t>(reach_);
    const double first = noise_deg_.front(), last = noise_deg_.back();
    noise_deg_.insert(noise_deg_.begin(), reach, first);
    noise_deg_.resize(noise_deg_.size() + reach + RowSums::spare, last);
}

}  // namespace stormcellar::retrieve
