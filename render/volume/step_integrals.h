// render/volume/step_integrals.h -- computes the second-order integrals of a transfer function, for
// many steps at once.
//
// A step over `distance` bins begins in the middle of one bin and ends in the middle of another. So
// it shows half a bin, then whole bins, then half a bin, each with its share of the step.
//
// Threads   Pure.
// Accuracy  Double precision, each sum in the order of the step: the same bits on every machine.
#pragma once

#include <array>
#include <cstddef>

namespace stormcellar::render {

inline constexpr std::size_t step_bins = 256;
// Vectors may read this many numbers beyond the last bin, but do not use them.
inline constexpr std::size_t bins_of_a_vector = 8;
using OfBins = std::array<double, step_bins + bins_of_a_vector>;

// The look of each bin: the optical depth of a step that is wholly in the bin, and its color.
struct BinLooks {
    OfBins depth{};
    std::array<OfBins, 3> color{};
};

// The opacity of the pieces of a step over some number of bins.
struct PieceOpacities {
    OfBins whole{}, half{};  // for each bin
};

// Entry i is for the step with bin i at its lower end: the color that leaves its front, the light
// that gets through it, and the sum of the depths of its bins.
struct StepIntegrals {
    std::array<OfBins, 3> color;
    OfBins through, depth;
};

enum class StepDirection { rising, falling };  // rising: the nearer end has the lower bin

// Integrates all steps over `distance` bins, front to back. `distance` is 1 to step_bins - 1. Sets
// the first step_bins - distance places of the result.
void integrate_steps(const BinLooks& looks, const PieceOpacities& opacities, std::size_t distance,
                     StepDirection direction, StepIntegrals& result);

}  // namespace stormcellar::render
