// grid/judge/robust_fit.h -- estimates a few numbers from many residuals, with honest errors
// although neighboring residuals are correlated.
//
// Method    One step of Gauss and Newton with iterated weights (Huber 1964): squares within 1.345
//           deviations, linear beyond. The deviation is 1.4826 times the median of the magnitudes
//           of the residuals.
// Errors    Neighboring cells have similar errors, so their number says little. Each row belongs to
//           a block. The errors are the jackknife's over blocks (each left out in turn; Efron and
//           Stein 1981). They hold whatever the rows of a block have in common.
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

// The numbers that are sought. The others stay as they are.
using FitChoice = std::array<bool, fit_size>;

struct Fit {
    std::array<double, fit_size> step{};  // to be added; 0 for a number that is not sought
    std::array<double, fit_size> standard_error{};  // infinite for fewer than two blocks
    std::size_t blocks = 0;                         // the number of blocks with rows
    double deviation = 0;                           // deviation of the residuals, from their median
};

// Fits the numbers. Returns none if the rows cannot tell the sought numbers apart. Then `unclear`,
// if given, is the first number that the rows do not determine.
[[nodiscard]] std::optional<Fit> fit(std::span<const FitRow> rows, FitChoice sought,
                                     std::size_t* unclear = nullptr);

}  // namespace stormcellar::grid
