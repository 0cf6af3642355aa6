#include "grid/judge/robust_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace stormcellar::grid {
namespace {

constexpr double huber_limit = 1.345;
constexpr double deviations_a_median = 1.4826;
// A number is determined if more than this share of its sum of squared gradients remains after the
// numbers before it were eliminated.
constexpr double least_pivot = 1e-4;

using Numbers = std::array<double, fit_size>;

// The normal equations. They are sums over the rows: of weight * gradient * gradient, and of weight
// * gradient * residual.
struct Equations {
    std::array<Numbers, fit_size> matrix{};
    Numbers right{};
    std::size_t rows = 0;

    void add(const FitRow& row, double weight) {
        ++rows;
        for (std::size_t i = 0; i < fit_size; ++i) {
            right[i] += weight * row.gradient[i] * row.residual;
            for (std::size_t j = 0; j < fit_size; ++j)
                matrix[i][j] += weight * row.gradient[i] * row.gradient[j];
        }
    }
    void add(const Equations& other, double sign) {
        for (std::size_t i = 0; i < fit_size; ++i) {
            right[i] += sign * other.right[i];
            for (std::size_t j = 0; j < fit_size; ++j)
                matrix[i][j] += sign * other.matrix[i][j];
        }
    }
};

// Solves the equations by Gaussian elimination. `of` is a copy; in it, the equation of a number
// that is not sought becomes trivial.
std::optional<Numbers> solve(Equations of, FitChoice sought, std::size_t* unclear) {
    for (std::size_t i = 0; i < fit_size; ++i) {
        if (sought[i]) continue;
        for (std::size_t j = 0; j < fit_size; ++j)
            of.matrix[i][j] = of.matrix[j][i] = 0;
        of.matrix[i][i] = 1;
        of.right[i] = 0;
    }
    const std::array<Numbers, fit_size> whole = of.matrix;
    for (std::size_t i = 0; i < fit_size; ++i) {
        if (!(of.matrix[i][i] > least_pivot * whole[i][i])) {
            if (unclear != nullptr) *unclear = i;
            return std::nullopt;
        }
        for (std::size_t below = i + 1; below < fit_size; ++below) {
            const double share = of.matrix[below][i] / of.matrix[i][i];
            for (std::size_t j = i; j < fit_size; ++j)
                of.matrix[below][j] -= share * of.matrix[i][j];
            of.right[below] -= share * of.right[i];
        }
    }
    Numbers found{};
    for (std::size_t i = fit_size; i-- > 0;) {
        double right = of.right[i];
        for (std::size_t j = i + 1; j < fit_size; ++j)
            right -= of.matrix[i][j] * found[j];
        found[i] = right / of.matrix[i][i];
    }
    return found;
}

double deviation_of(std::span<const FitRow> rows) {
    std::vector<double> sizes;
    sizes.reserve(rows.size());
    for (const FitRow& row : rows)
        sizes.push_back(std::abs(row.residual));
    const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
    std::nth_element(sizes.begin(), middle, sizes.end());
    return deviations_a_median * *middle;
}

std::vector<Equations> equations_of_blocks(std::span<const FitRow> rows, double deviation) {
    std::vector<Equations> blocks;
    const double limit = huber_limit * deviation;
    for (const FitRow& row : rows) {
        if (row.block >= blocks.size()) blocks.resize(row.block + std::size_t{1});
        const double size = std::abs(row.residual);
        blocks[row.block].add(row, size <= limit ? 1 : limit / size);
    }
    std::erase_if(blocks, [](const Equations& block) { return block.rows == 0; });
    return blocks;
}

// Leaves out each block in turn and solves for the numbers. Returns their standard errors, computed
// from the scatter of these solutions.
Numbers jackknife(const std::vector<Equations>& blocks, const Equations& all, FitChoice sought) {
    Numbers errors;
    errors.fill(std::numeric_limits<double>::infinity());
    if (blocks.size() < 2) return errors;
    Numbers sum{};
    Numbers squares{};
    for (const Equations& block : blocks) {
        Equations others = all;
        others.add(block, -1);
        const auto without = solve(others, sought, nullptr);
        if (!without) return errors;  // a number is determined by this block only
        for (std::size_t i = 0; i < fit_size; ++i) {
            sum[i] += (*without)[i];
            squares[i] += (*without)[i] * (*without)[i];
        }
    }
    const auto count = static_cast<double>(blocks.size());
    for (std::size_t i = 0; i < fit_size; ++i) {
        const double scatter = std::max(0.0, squares[i] - sum[i] * sum[i] / count);
        errors[i] = std::sqrt((count - 1) / count * scatter);
    }
    return errors;
}

}  // namespace

std::optional<Fit> fit(std::span<const FitRow> rows, FitChoice sought, std::size_t* unclear) {
    if (rows.empty()) {
        if (unclear != nullptr) *unclear = 0;
        return std::nullopt;
    }
    Fit made{.deviation = deviation_of(rows)};
    // If half the residuals are 0, the deviation is 0 as well. All other rows would then be
    // outliers without weight. They keep a weight if the deviation is at least 1e-9.
    const double deviation = std::max(made.deviation, 1e-9);
    const std::vector<Equations> blocks = equations_of_blocks(rows, deviation);
    Equations all;
    for (const Equations& block : blocks)
        all.add(block, 1);
    const auto step = solve(all, sought, unclear);
    if (!step) return std::nullopt;
    made.step = *step;
    made.blocks = blocks.size();
    made.standard_error = jackknife(blocks, all, sought);
    return made;
}

}  // namespace stormcellar::grid
