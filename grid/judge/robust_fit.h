// grid/judge/robust_fit.h -- a few numbers from many residuals that are off together, with honest
// errors.
//
// One step of Gauss and Newton by iterated weights (Huber 1964: squares within 1.345 deviations,
// the deviation being 1.4826 times the median of the residuals' sizes, linear beyond).
// Errors   cells beside each other err alike, so that their number says little. Rows belong to
//          blocks, and the errors are the jackknife's over blocks (each left out in turn; Efron and
//          Stein 1981), which holds whatever the rows of a block have in common.
// Threads  pure functions; the same bits every time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace stormcellar::grid {

inline constexpr std::size_t fit_size = 4;

struct FitRow {
    std::array<double, fit_size> gradient{};  // of the model, by each number
    double residual = 0;                      // seen minus model
    std::uint32_t block = 0;                  // 0, 1, ...
};

// Which of the numbers are sought; the others stay.
using FitChoice = std::array<bool, fit_size>;

struct Fit {
    std::array<double, fit_size> step{};            // to be added; 0 of what is not sought
    std::array<double, fit_size> standard_error{};  // infinite for fewer than two blocks
    std::size_t blocks = 0;                         // that have rows
    double deviation = 0;                           // of the residuals, by their median
};

// None where the rows do not tell the numbers sought from each other; `unclear`, where given, is
// then the first that they do not tell.
[[nodiscard]] std::optional<Fit> fit(std::span<const FitRow> rows, FitChoice sought,
                                     std::size_t* unclear = nullptr);

}  // namespace stormcellar::grid
