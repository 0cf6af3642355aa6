#include "retrieve/cyclone/polar_velocity.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/degree.h"
#include "retrieve/dealias/velocity_sheet.h"
#include "stormcellar/grid/beam_geometry.h"

namespace stormcellar::retrieve {
namespace {

constexpr double most_mps = 110;  // faster gates are damage or wrong fold numbers
constexpr std::size_t azimuth_steps = 3600;
constexpr double widest_step_deg = 3;  // radials farther apart have a gap between them

float turned(float azimuth_deg) {
    const float turned = std::fmod(azimuth_deg, 360.0F);
    return turned < 0 ? turned + 360 : turned;
}

// Moves a velocity by whole turns until it is nearest to `expected`, unless `expected` is NaN.
double nearest(double velocity_mps, double expected_mps, float turn_mps) {
    const auto turn = static_cast<double>(turn_mps);
    return std::isnan(expected_mps) || std::abs(expected_mps - velocity_mps) <= turn / 2
               ? velocity_mps
               : velocity_mps + turn * std::round((expected_mps - velocity_mps) / turn);
}

double median(std::vector<double>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    if (values.size() % 2 == 1) return *middle;
    return (*middle + *std::max_element(values.begin(), middle)) / 2;
}

}  // namespace

std::vector<std::size_t> usable_radials(const level2::Sweep& sweep,
                                        const level2::SweepMoment& moment) {
    std::vector<std::size_t> usable;
    for (std::size_t radial = 0; radial < sweep.radials.size(); ++radial) {
        if (moment.gate_counts[radial] > 0 && can_be_unfolded(sweep.radials[radial]))
            usable.push_back(radial);
    }
    std::ranges::stable_sort(
        usable, {}, [&](std::size_t radial) { return turned(sweep.radials[radial].azimuth_deg); });
    return usable;
}

PolarVelocity::PolarVelocity(const level2::Volume& volume, const SweepFolds& folds) {
    const level2::Sweep& sweep = volume.sweeps[folds.sweep];
    const level2::SweepMoment& moment = sweep.moments[folds.moment];
    const std::vector<std::size_t> radials = usable_radials(sweep, moment);
    if (radials.empty() || moment.gate_stride <= 0) return;
    for (const std::size_t radial : radials) {
        azimuths_deg_.push_back(turned(sweep.radials[radial].azimuth_deg));
        turns_mps_.push_back(2 * sweep.radials[radial].nyquist_mps);
        elevation_deg_ += static_cast<double>(sweep.radials[radial].elevation_deg);
    }
    elevation_deg_ /= static_cast<double>(radials.size());
    index_azimuths();
    fill_bins(sweep, radials, folds);
}

void PolarVelocity::index_azimuths() {
    std::size_t row = 0;
    for (std::size_t step = 0; step < azimuth_steps; ++step) {
        const auto azimuth = static_cast<float>(step) * (360.0F / azimuth_steps);
        while (row < azimuths_deg_.size() && azimuths_deg_[row] < azimuth)
            ++row;
        row_after_.push_back(row);
    }
}

void PolarVelocity::fill_bins(const level2::Sweep& sweep, const std::vector<std::size_t>& radials,
                              const SweepFolds& folds) {
    const level2::SweepMoment& moment = sweep.moments[folds.moment];
    // Find the bin of each gate. The bin is the same in all radials, whose elevations hardly
    // differ.
    const grid::BeamGeometry beam(40, 0);
    bin_m_ = std::max(1000.0, static_cast<double>(moment.gate_spacing_m));
    std::vector<std::size_t> bin_of_gate;
    for (std::int32_t gate = 0; gate < moment.gate_stride; ++gate) {
        reach_m_ = std::max(0.0, beam.forward({moment.range_m(gate), elevation_deg_}).arc_m);
        bin_of_gate.push_back(static_cast<std::size_t>(reach_m_ / bin_m_));
    }
    bins_in_row_ = bin_of_gate.back() + 1;
    bins_.assign(radials.size() * bins_in_row_, std::numeric_limits<float>::quiet_NaN());

    // Take the median of the gates of each bin. The median is right even if one gate has a wrong
    // fold number.
    const double level = 1 / std::cos(elevation_deg_ * degree);
    std::vector<double> gates;
    for (std::size_t row = 0; row < radials.size(); ++row) {
        const std::size_t radial = radials[row];
        const auto turn_mps = static_cast<double>(turns_mps_[row]);
        const std::int32_t count = moment.gate_counts[radial];
        for (std::int32_t gate = 0; gate < count;) {
            const std::size_t bin = bin_of_gate[static_cast<std::size_t>(gate)];
            gates.clear();
            for (; gate < count && bin_of_gate[static_cast<std::size_t>(gate)] == bin; ++gate) {
                const std::uint16_t code = moment.code(radial, gate);
                if (status_of_code(moment.moment, code) != level2::GateStatus::valid) continue;
                const std::size_t at = radial * static_cast<std::size_t>(moment.gate_stride) +
                                       static_cast<std::size_t>(gate);
                const double velocity =
                    static_cast<double>(moment.value_of(code)) + turn_mps * folds.folds[at];
                if (std::abs(velocity) <= most_mps) gates.push_back(velocity);
            }
            if (gates.empty()) continue;
            bins_[row * bins_in_row_ + bin] = static_cast<float>(median(gates) * level);
            ++values_;
        }
    }
}

double PolarVelocity::at(double x_m, double y_m, double expected_mps) const {
    constexpr double nothing = std::numeric_limits<double>::quiet_NaN();
    const double place = std::hypot(x_m, y_m) / bin_m_ - 0.5;
    if (!(place >= 0) || place >= static_cast<double>(bins_in_row_) - 1) return nothing;
    double azimuth = std::atan2(x_m, y_m) / degree;
    if (azimuth < 0) azimuth += 360;

    // Find the rows on both sides of the azimuth.
    const std::size_t rows = azimuths_deg_.size();
    const auto step = static_cast<std::size_t>(azimuth * (azimuth_steps / 360.0));
    std::size_t after = row_after_[std::min(step, azimuth_steps - 1)];
    while (after < rows && static_cast<double>(azimuths_deg_[after]) < azimuth)
        ++after;
    const std::size_t right = after % rows, left = (after + rows - 1) % rows;
    double width =
        static_cast<double>(azimuths_deg_[right]) - static_cast<double>(azimuths_deg_[left]);
    double part = azimuth - static_cast<double>(azimuths_deg_[left]);
    if (width < 0 || rows == 1) width += 360;
    if (part < 0) part += 360;
    if (width > widest_step_deg) return nothing;
    part = width > 0 ? part / width : 0;

    // Interpolate between the bins that have a value.
    const auto bin = static_cast<std::size_t>(place);
    const double along = place - static_cast<double>(bin);
    double sum = 0, weights = 0;
    const auto add = [&](std::size_t row, std::size_t its_bin, double weight) {
        const float value = bins_[row * bins_in_row_ + its_bin];
        if (std::isnan(value)) return;
        const double moved = nearest(static_cast<double>(value), expected_mps, turns_mps_[row]);
        sum += weight * moved;
        weights += weight;
    };
    add(left, bin, (1 - part) * (1 - along));
    add(left, bin + 1, (1 - part) * along);
    add(right, bin, part * (1 - along));
    add(right, bin + 1, part * along);
    return weights < 0.5 ? nothing : sum / weights;
}

void PolarVelocity::refold(const std::function<double(double x_m, double y_m)>& expected) {
    for (std::size_t row = 0; row < azimuths_deg_.size(); ++row) {
        const double azimuth = static_cast<double>(azimuths_deg_[row]) * degree;
        const double east = std::sin(azimuth), north = std::cos(azimuth);
        for (std::size_t bin = 0; bin < bins_in_row_; ++bin) {
            float& value = bins_[row * bins_in_row_ + bin];
            if (std::isnan(value)) continue;
            const double arc = (static_cast<double>(bin) + 0.5) * bin_m_;
            value = static_cast<float>(nearest(static_cast<double>(value),
                                               expected(arc * east, arc * north), turns_mps_[row]));
        }
    }
}

std::size_t PolarVelocity::differences(const PolarVelocity& other) const {
    std::size_t count = 0;
    for (std::size_t i = 0; i < bins_.size(); ++i) {
        const float moved_mps = std::abs(bins_[i] - other.bins_[i]);
        count += (std::isnan(moved_mps) ? 0 : moved_mps) > 1 ? 1 : 0;
    }
    return count;
}

double PolarVelocity::height_m(double arc_m) const {
    return grid::BeamGeometry(40, 0).over(arc_m, elevation_deg_).height_m;
}

}  // namespace stormcellar::retrieve
