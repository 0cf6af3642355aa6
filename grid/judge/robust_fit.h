// grid/judge/robust_fit.h -- estimates a few numbers from many residuals, with standard errors that
// allow for correlated neighbors.
//
// Method    One step of Gauss and Newton with iterated weights (Huber 1964): squares within 1.345
//           deviations, linear beyond. The deviation is 1.4826 times the median of the residuals'
//           magnitudes.
// Errors    Neighboring cells have similar errors, so they say less than as many independent cells.
//           Each row belongs to a block. The standard errors come from the jackknife over blocks
//           (each left out in turn; Efron and Stein 1981), so rows of one block may have anything
//           in common.
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
    std::array<double, fit_size> gradient{};  // derivative of the model by each number
    double residual = 0;                      // seen minus model
    std::uint32_t block = 0;                  // 0, 1, ...
};

// True for each number to estimate; the other numbers do not change.
using FitChoice = std::array<bool, fit_size>;

struct Fit {
    std::array<double, fit_size> step{};            // to add; 0 for a number that is not estimated
    std::array<double, fit_size> standard_error{};  // infinite if a block alone determines a number
    std::size_t blocks = 0;                         // the number of blocks with rows
    double deviation = 0;                           // 1.4826 * median magnitude of the residuals
};

// Fits the numbers. Returns none if the rows do not determine all of them; then `unclear`, unless
// null, is the first such number.
[[nodiscard]] std::optional<Fit> fit(std::span<const FitRow> rows, FitChoice sought,
                                     std::size_t* unclear = nullptr);

}  // namespace stormcellar::grid
