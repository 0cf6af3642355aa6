#include "render/volume/transfer_function.h"

#include <array>
#include <cmath>

namespace stormcellar::render {
namespace {

constexpr double class_slack = 1.0 / 64;  // bins

// Running sums over the bins of extinction, and of extinction times colour.
struct Sums {
    double extinction = 0;
    std::array<double, 3> colour{};
};

std::vector<Sums> sums_of(const ColourTable& table, double opacity) {
    std::vector<Sums> sums(TransferFunction::bin_count + 1);
    for (std::size_t i = 0; i < TransferFunction::bin_count; ++i) {
        const double dbz =
            TransferFunction::first_bin_dbz + TransferFunction::bin_dbz * static_cast<double>(i);
        const double extinction = extinction_per_m(table, dbz, opacity);
        const Rgba8 colour = colour_of(table, static_cast<float>(dbz)).value_or(Rgba8{0, 0, 0, 0});
        sums[i + 1] = sums[i];
        sums[i + 1].extinction += extinction;
        for (std::size_t c = 0; c < 3; ++c)
            sums[i + 1].colour[c] += extinction * colour[c] / 255;
    }
    return sums;
}

// The bins from `low` up to and with `high`, each for the same share of the step.
TransferEntry entry_of(const std::vector<Sums>& sums, std::size_t low, std::size_t high,
                       double step_m) {
    const double bins = static_cast<double>(high - low + 1);
    const double extinction = sums[high + 1].extinction - sums[low].extinction;
    if (extinction <= 0) return {};
    const double alpha = -std::expm1(-extinction / bins * step_m);
    const auto colour = [&](std::size_t c) {
        return static_cast<float>(alpha * (sums[high + 1].colour[c] - sums[low].colour[c]) /
                                  extinction);
    };
    return {colour(0), colour(1), colour(2), static_cast<float>(alpha)};
}

}  // namespace

TransferFunction::TransferFunction(const ColourTable& table, const grid::Quantization& quantization,
                                   double opacity, double step_m)
    : entries_(static_cast<std::size_t>(bin_count) * bin_count) {
    const double step = static_cast<double>(quantization.step);
    const double code_zero_dbz =
        static_cast<double>(quantization.first_value) - step * grid::first_value_code;
    bin_slope_ = static_cast<float>(step / bin_dbz);
    bin_offset_ = static_cast<float>((code_zero_dbz - first_bin_dbz) / bin_dbz + class_slack);

    const std::vector<Sums> sums = sums_of(table, opacity);
    std::size_t first_visible_bin = 0;
    while (first_visible_bin < bin_count && sums[first_visible_bin + 1].extinction <= 0) {
        ++first_visible_bin;
    }
    for (std::size_t high = first_visible_bin; high < bin_count; ++high) {
        for (std::size_t low = 0; low <= high; ++low) {
            const TransferEntry entry = entry_of(sums, low, high, step_m);
            entries_[low * bin_count + high] = entry;
            entries_[high * bin_count + low] = entry;
        }
    }
    const std::uint32_t past = std::uint32_t{quantization.largest_code()} + 1;
    first_visible_code_ = grid::first_value_code;
    while (first_visible_code_ < past &&
           bin(static_cast<float>(first_visible_code_)) < static_cast<int>(first_visible_bin)) {
        ++first_visible_code_;
    }
}

}  // namespace stormcellar::render
