// render/volume/transfer_function.h -- a colour table made ready for steps through a volume.
//
// A path of length s through an extinction k (ColourTable::extinction) has the opacity
// 1 - exp(-k s); in terms of the opacity a of a reference step ds0 that is 1 - (1 - a)^(s / ds0).
// Lengths are those of the drawn scene, with heights exaggerated.
//
// The table holds, for each pair of values at the two ends of a step, the colour and opacity of
// all values between them, so that a step that crosses a class shows each class for its share.
// What a step's near part hides of its far part is left out: first order in the step.
// Thread contract: immutable.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "grid/brick_view.h"
#include "render/colour/colour_table.h"

namespace stormcellar::render {

// Colours are premultiplied by alpha.
struct TransferEntry {
    float red = 0, green = 0, blue = 0;  // 0..1
    float alpha = 0;                     // 0..1
};

class TransferFunction {
  public:
    // Values are sorted into bins of half a decibel, whose lower ends include those of the classes;
    // all values of a bin look like its lower end.
    static constexpr int bin_count = 256;
    static constexpr double first_bin_dbz = -32;
    static constexpr double bin_dbz = 0.5;

    // For steps of `step_m` in the drawn scene.
    TransferFunction(const ColourTable& table, const grid::Quantization& quantization,
                     double opacity, double step_m);

    // The bin of a code, which may be broken (the mean of several), is the whole part of
    // bin_offset + bin_slope * code, bounded. It is never below the right one by rounding: values
    // up to 1/64 of a bin short of it belong to it.
    [[nodiscard]] float bin_offset() const { return bin_offset_; }
    [[nodiscard]] float bin_slope() const { return bin_slope_; }
    [[nodiscard]] int bin(float code) const {
        return static_cast<int>(
            std::clamp(bin_offset_ + bin_slope_ * code, 0.0F, bin_count - 1.0F));
    }
    // A step with these bins at its ends; the order does not matter.
    [[nodiscard]] const TransferEntry& entry(int bin, int other_bin) const {
        return entries_[static_cast<std::size_t>(bin) * bin_count +
                        static_cast<std::size_t>(other_bin)];
    }
    // Codes below this one are clear. One more than the largest when all are.
    [[nodiscard]] std::uint32_t first_visible_code() const { return first_visible_code_; }

  private:
    std::vector<TransferEntry> entries_;
    float bin_offset_ = 0, bin_slope_ = 0;
    std::uint32_t first_visible_code_ = 0;
};

}  // namespace stormcellar::render
