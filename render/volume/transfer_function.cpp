#include "render/volume/transfer_function.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"
#include "render/volume/step_integrals.h"

namespace stormcellar::render {
namespace {

constexpr double bin_slack = 1.0 / 64;  // bins
constexpr auto bins = static_cast<std::size_t>(TransferFunction::bin_count);
static_assert(bins == step_bins);

using Entries = std::vector<TransferEntry>;

TransferEntry entry_of(double red, double green, double blue, double depth) {
    return {static_cast<float>(red), static_cast<float>(green), static_cast<float>(blue),
            static_cast<float>(depth)};
}

// Uses only the nearer value, so the second bin does not matter.
void fill_riemann(const BinLooks& look, Entries& entries) {
    for (std::size_t i = 0; i < bins; ++i) {
        const auto entry =
            entry_of(look.color[0][i], look.color[1][i], look.color[2][i], look.depth[i]);
        std::fill_n(entries.begin() + static_cast<std::ptrdiff_t>(i * bins), bins, entry);
    }
}

// Adds up the bins: whole bins between the ends, and half of the bin at each end.
void fill_first_order(const BinLooks& look, Entries& entries) {
    for (std::size_t i = 0; i < bins; ++i) {
        double depth = 0;
        std::array<double, 3> color{};
        const auto add = [&](std::size_t bin, double share) {
            depth += share * look.depth[bin];
            for (std::size_t c = 0; c < 3; ++c)
                color[c] += share * look.depth[bin] * look.color[c][bin];
        };
        add(i, 1);
        for (std::size_t j = i; j < bins; ++j) {
            if (j == i + 1) {  // from one whole bin to two halves
                add(i, -0.5);
                add(j, 0.5);
            } else if (j > i + 1) {
                add(j - 1, 0.5);
                add(j, 0.5);
            }
            if (depth <= 0) continue;
            const double length = j == i ? 1 : static_cast<double>(j - i);
            const TransferEntry entry =
                entry_of(color[0] / depth, color[1] / depth, color[2] / depth, depth / length);
            entries[i * bins + j] = entry;
            entries[j * bins + i] = entry;
        }
    }
}

// Sets the look of all steps over `distance` bins in one direction.
void put_steps(const StepIntegrals& steps, std::size_t distance, StepDirection direction,
               Entries& entries) {
    const double piece = 1.0 / static_cast<double>(distance);
    for (std::size_t i = 0; i < bins - distance; ++i) {
        const double seen = 1 - steps.through[i];
        if (!(seen > 0)) continue;
        const std::size_t place = direction == StepDirection::rising ? i * bins + i + distance
                                                                     : (i + distance) * bins + i;
        entries[place] = entry_of(steps.color[0][i] / seen, steps.color[1][i] / seen,
                                  steps.color[2][i] / seen, steps.depth[i] * piece);
    }
}

PieceOpacities opacities_of(const BinLooks& look, std::size_t distance) {
    const double piece = 1.0 / static_cast<double>(distance);
    PieceOpacities opacities;
    for (std::size_t i = 0; i < bins; ++i) {
        if (look.depth[i] <= 0) continue;
        opacities.half[i] = -std::expm1(-0.5 * piece * look.depth[i]);
        opacities.whole[i] = -std::expm1(-piece * look.depth[i]);
    }
    return opacities;
}

void fill_second_order(const BinLooks& look, int threads, Entries& entries) {
    for (std::size_t i = 0; i < bins; ++i) {
        if (look.depth[i] <= 0) continue;
        entries[i * bins + i] =
            entry_of(look.color[0][i], look.color[1][i], look.color[2][i], look.depth[i]);
    }
    // Each distance has entries of its own.
    for_each_piece(static_cast<int>(bins) - 1, threads, [&](int piece) {
        const auto distance = static_cast<std::size_t>(piece) + 1;
        StepIntegrals steps;
        const PieceOpacities opacities = opacities_of(look, distance);
        for (const StepDirection direction : {StepDirection::rising, StepDirection::falling}) {
            integrate_steps(look, opacities, distance, direction, steps);
            put_steps(steps, distance, direction, entries);
        }
    });
}

}  // namespace

std::string_view integration_name(Integration integration) {
    constexpr std::array<std::string_view, 3> names = {"riemann", "pre-integrated",
                                                       "pre-integrated-2"};
    return names[static_cast<std::size_t>(integration)];
}

// The bin of a stop begins at the stop, if there is a whole number of bins between any two stops.
void TransferFunction::choose_bins(const ColorTable& table) {
    const auto& stops = table.stops;
    lowest_ = static_cast<double>(std::max(table.lowest(), table.extinction.front().value));
    const auto highest =
        static_cast<double>(std::max(stops.back().from, table.extinction.back().value));
    const double range = std::max(highest - lowest_, 1e-6);
    double gap = range;
    for (std::size_t i = 1; i < stops.size(); ++i)
        gap = std::min(gap, static_cast<double>(stops[i].from - stops[i - 1].from));
    // One bin is for the clear values below the table, and one for the values from the highest stop
    // on.
    const double finest = range / (bin_count - 2);
    const double bins_a_gap = std::floor(gap / finest * (1 + 1e-9));
    bin_width_ = bins_a_gap >= 1 ? gap / bins_a_gap : finest;
}

TransferFunction::TransferFunction(const ColorTable& table, const grid::Quantization& quantization,
                                   double opacity, double step_m, Integration integration,
                                   int threads)
    : entries_(bins * bins), visible_below_(bins + 1) {
    choose_bins(table);
    const auto step = static_cast<double>(quantization.step);
    const double code_zero =
        static_cast<double>(quantization.first_value) - step * grid::first_value_code;
    bin_slope_ = static_cast<float>(step / bin_width_);
    bin_offset_ = static_cast<float>((code_zero - lowest_) / bin_width_ + 1 + bin_slack);

    // Compute the look of each bin from its middle value. Then count visible bins, so that shows()
    // needs only one subtraction for any range. Then make the entries for all pairs of bins.
    BinLooks look;
    for (int i = 1; i < bin_count; ++i) {
        const auto at = static_cast<std::size_t>(i);
        look.depth[at] = extinction_per_m(table, value_of(i), opacity) * step_m;
        const auto color = color_of(table, static_cast<float>(value_of(i)));
        for (std::size_t c = 0; c < 3 && color; ++c)
            look.color[c][at] = (*color)[c] / 255.0;
    }
    for (std::size_t i = 0; i < bins; ++i)
        visible_below_[i + 1] = visible_below_[i] + (look.depth[i] > 0 ? 1 : 0);
    if (integration == Integration::riemann) fill_riemann(look, entries_);
    if (integration == Integration::first_order) fill_first_order(look, entries_);
    if (integration == Integration::second_order) fill_second_order(look, threads, entries_);
}

}  // namespace stormcellar::render
