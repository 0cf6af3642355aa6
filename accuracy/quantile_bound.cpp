#include "accuracy/quantile_bound.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace stormcellar::accuracy {
namespace {

// Relative rounding error that a weight times a count may have.
constexpr double weight_slack = 1e-9;

double magnitude(double error) {
    return std::isnan(error) ? std::numeric_limits<double>::infinity() : std::fabs(error);
}

bool sensible(const BoundRequest& request) {
    // Comparing a NaN would trap.
    if (std::isnan(request.quantile) || std::isnan(request.confidence)) return false;
    return request.quantile > 0 && request.quantile < 1 && request.confidence > 0 &&
           request.confidence < 1;
}

// Returns how many of n errors may exceed the bound: the largest c for which at most c errors
// exceed the true quantile with a probability of at most 1 - confidence. Returns none if even "no
// errors exceed the bound" is too likely.
std::optional<std::size_t> allowed_exceedances(std::size_t n, const BoundRequest& request) {
    const auto count = static_cast<double>(n);
    const double log_odds = std::log1p(-request.quantile) - std::log(request.quantile);
    double log_probability = count * std::log(request.quantile);  // for exactly k errors
    double sum = std::exp(log_probability);
    if (sum > 1 - request.confidence) return std::nullopt;
    std::size_t k = 0;
    while (k + 1 < n) {
        const auto next = static_cast<double>(k + 1);
        log_probability += std::log((count - next + 1) / next) + log_odds;
        sum += std::exp(log_probability);
        if (sum > 1 - request.confidence) break;
        ++k;
    }
    return k;
}

// A cluster with its errors sorted, for log_capital().
struct Column {
    std::vector<double> sorted;  // magnitudes
    double weight = 1;
};

// The number of stakes. Each stake bets a different fraction of its capital.
constexpr std::size_t stake_count = 8;

// Returns the logarithm of the capital won by betting that t is at least the quantile, as a mean
// over the stakes. The result rises with t.
double log_capital(const std::vector<Column>& columns, double t, double largest_stake,
                   double allowed_share) {
    std::array<double, stake_count> logs{};
    for (const Column& column : columns) {
        const auto above = std::upper_bound(column.sorted.begin(), column.sorted.end(), t);
        const auto exceeding = static_cast<double>(column.sorted.end() - above);
        const auto size = static_cast<double>(column.sorted.size());
        const double loss = column.weight * (exceeding - allowed_share * size);
        double stake = largest_stake;
        for (double& log : logs) {
            log += std::log1p(-stake * loss);
            stake /= 2;
        }
    }
    const double largest = *std::max_element(logs.begin(), logs.end());
    double sum = 0;
    for (const double log : logs)
        sum += std::exp(log - largest);
    return largest + std::log(sum / stake_count);
}

}  // namespace

std::optional<double> quantile_upper_bound(std::span<const double> errors,
                                           const BoundRequest& request) {
    if (errors.empty() || !sensible(request)) return std::nullopt;
    const auto allowed = allowed_exceedances(errors.size(), request);
    if (!allowed) return std::nullopt;
    std::vector<double> magnitudes(errors.size());
    std::transform(errors.begin(), errors.end(), magnitudes.begin(), magnitude);
    const auto bound = magnitudes.end() - 1 - static_cast<std::ptrdiff_t>(*allowed);
    std::nth_element(magnitudes.begin(), bound, magnitudes.end());
    return *bound;
}

std::optional<double> quantile_upper_bound(std::span<const ErrorCluster> clusters,
                                           double most_weight, const BoundRequest& request) {
    if (!sensible(request) || !std::isfinite(most_weight) || most_weight <= 0) return std::nullopt;
    std::vector<Column> columns;
    std::vector<double> candidates;
    for (const ErrorCluster& cluster : clusters) {
        if (!std::isfinite(cluster.weight) || cluster.weight <= 0) return std::nullopt;
        const double held = cluster.weight * static_cast<double>(cluster.errors.size());
        if (held > most_weight * (1 + weight_slack)) return std::nullopt;
        if (cluster.errors.empty()) continue;
        Column column{cluster.errors, cluster.weight};
        for (double& error : column.sorted)
            error = magnitude(error);
        std::sort(column.sorted.begin(), column.sorted.end());
        candidates.insert(candidates.end(), column.sorted.begin(), column.sorted.end());
        columns.push_back(std::move(column));
    }
    if (candidates.empty()) return std::nullopt;
    for (Column& column : columns)
        column.weight /= most_weight;
    std::sort(candidates.begin(), candidates.end());

    // Choose the largest stake so that a cluster of most_weight leaves some capital even if all its
    // errors exceed t.
    const double largest_stake = 0.99 / request.quantile;
    const double needed = -std::log(1 - request.confidence);
    const auto wins = [&](double t) {
        return log_capital(columns, t, largest_stake, 1 - request.quantile) >= needed;
    };
    if (!wins(candidates.back())) return std::nullopt;
    return *std::partition_point(candidates.begin(), candidates.end(),
                                 [&](double t) { return !wins(t); });
}

}  // namespace stormcellar::accuracy
