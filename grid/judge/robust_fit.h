// grid/judge/robust_fit.h -- estimates a few numbers from many residuals. The standard errors allow
// for correlation between neighboring cells.
//
// Method    One step of Gauss and Newton with iterated weights (Huber 1964): the error counts as
//           its square within 1.345 deviations, and linearly beyond. The deviation is 1.4826 times
//           the median of the magnitudes of the residuals.
// Errors    Neighboring cells have similar errors, so they say less than as many independent cells.
//           Each row belongs to a block. The standard errors come from the jackknife, which leaves
//           out one block at a time (Efron and Stein 1981). So the errors within a block may depend
//           on each other in any way.
// Threads   Pure functions, with the same bits every time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace stormcellar::grid {

inline constexpr std::size_t fit_size = 4;

struct FitRow {
    std::array<double, fit_size> gradient{};  // derivative of the model with respect to each number
    double residual = 0;                      // seen minus model
    std::uint32_t block = 0;                  // 0, 1, ...
};

// True for each number that is estimated. No other number changes.
using FitChoice = std::array<bool, fit_size>;

struct Fit {
    // To add to the numbers; 0 for a number that is not estimated.
    std::array<double, fit_size> step{};
    // Infinite if one block alone determines a number.
    std::array<double, fit_size> standard_error{};
    std::size_t blocks = 0;  // the number of blocks with rows
    // 1.4826 * median of the magnitudes of the residuals.
    double deviation = 0;
};

// Fits the numbers. If the rows do not determine all numbers, returns none and sets `unclear`,
// unless it is null, to the first number that is not determined.
[[nodiscard]] std::optional<Fit> fit(std::span<const FitRow> rows, FitChoice sought,
                                     std::size_t* unclear = nullptr);

}  // namespace stormcellar::grid
