// render/volume/transfer_function.h -- prepares a color table for steps through a volume.
//
// A path of length s through an extinction k (ColorTable::extinction) has the optical depth k s and
// the opacity 1 - exp(-k s). Lengths are those of the drawn scene, with heights exaggerated.
//
// Values are sorted into bins, and all values of a bin look like its middle. Bin 0 is clear; it
// holds the values below the table or below its first extinction. The other bins have equal widths.
// The last bin holds the highest stop of the table, and each stop begins a bin if possible. For
// each pair of bins at the two ends of a step, the table holds the look of the step from its first
// end, by the rules of stormcellar/render/integration.h.
//
// Threads   Immutable.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "stormcellar/grid/brick_view.h"
#include "stormcellar/render/color_table.h"
#include "stormcellar/render/integration.h"

namespace stormcellar::render {

// The look of a step of the reference length that has values over its whole width. A step of
// another length or another share of values has the same color; its depth is multiplied by the
// ratio of the lengths and by the share.
struct TransferEntry {
    float red = 0, green = 0, blue = 0;  // 0..1, not premultiplied
    float depth = 0;                     // optical depth
};

class TransferFunction {
  public:
    static constexpr int bin_count = 256;

    // Makes the table for steps of `step_m` in the drawn scene. The bits do not depend on the
    // number of threads.
    TransferFunction(const ColorTable& table, const grid::Quantization& quantization,
                     double opacity, double step_m, Integration integration, int threads = 1);

    // The bin of a code is the whole part of bin_offset + bin_slope * code, bounded. The code may
    // have a fraction (the mean of several codes). Rounding never makes the bin too low, because
    // values up to 1/64 of a bin below the start of a bin belong to it.
    [[nodiscard]] float bin_offset() const { return bin_offset_; }
    [[nodiscard]] float bin_slope() const { return bin_slope_; }
    [[nodiscard]] int bin(float code) const {
        return static_cast<int>(
            std::clamp(bin_offset_ + bin_slope_ * code, 0.0F, bin_count - 1.0F));
    }
    // Returns the value that a bin looks like. Bin 0 has no such value.
    [[nodiscard]] double value_of(int bin) const { return lowest_ + (bin - 0.5) * bin_width_; }
    [[nodiscard]] double bin_width() const { return bin_width_; }
    // Returns the look of a step from one bin to another, the nearer bin first.
    [[nodiscard]] const TransferEntry& entry(int bin, int other_bin) const {
        return entries_[static_cast<std::size_t>(bin) * bin_count +
                        static_cast<std::size_t>(other_bin)];
    }
    // Returns true if any value between those of the two codes, ends included, is not clear.
    [[nodiscard]] bool shows(std::uint16_t least_code, std::uint16_t largest_code) const {
        const auto first = static_cast<std::size_t>(bin(least_code));
        const auto last = static_cast<std::size_t>(bin(largest_code));
        return visible_below_[last + 1] > visible_below_[first];
    }

  private:
    void choose_bins(const ColorTable& table);

    double lowest_ = 0, bin_width_ = 1;
    float bin_offset_ = 0, bin_slope_ = 0;
    std::vector<TransferEntry> entries_;
    // For each bin, the number of bins below it that are not clear.
    std::vector<int> visible_below_;
};

}  // namespace stormcellar::render
