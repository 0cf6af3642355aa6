#include "stormcellar/accuracy/error_statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stormcellar::accuracy {
namespace {

// Largest relative rounding error of sums of weights and of their products with q. Comparisons of
// ranks allow for this error, so that rounding does not shift a rank.
constexpr double share_slack = 1e-12;

struct Weighted {
    double magnitude = 0;
    double weight = 1;
};

Weighted weigh(double error, double weight) {
    if (std::isnan(error)) return {std::numeric_limits<double>::infinity(), weight};
    return {std::fabs(error), weight};
}

// Returns a quantile of a list that is sorted by magnitude and not empty.
double quantile(const std::vector<Weighted>& sorted, double total_weight, double q) {
    const double needed = q * total_weight * (1 - share_slack);
    double sum = 0;
    for (const Weighted& entry : sorted) {
        sum += entry.weight;
        if (sum >= needed) return entry.magnitude;
    }
    return sorted.back().magnitude;
}

std::optional<ErrorSummary> summarize_weighted(std::vector<Weighted> list) {
    if (list.empty()) return std::nullopt;
    std::sort(list.begin(), list.end(),
              [](const Weighted& a, const Weighted& b) { return a.magnitude < b.magnitude; });
    ErrorSummary summary{.count = list.size(), .max = list.back().magnitude};
    double total = 0;
    double squares = 0;
    for (const Weighted& entry : list) {
        total += entry.weight;
        // Divide by the largest error before squaring, so that no square overflows.
        if (summary.max > 0 && !std::isinf(summary.max)) {
            const double part = entry.magnitude / summary.max;
            squares += entry.weight * part * part;
        }
    }
    summary.rms = std::isinf(summary.max) ? summary.max : summary.max * std::sqrt(squares / total);
    summary.p95 = quantile(list, total, 0.95);
    summary.p99 = quantile(list, total, 0.99);
    return summary;
}

}  // namespace

std::optional<ErrorSummary> summarize(std::span<const double> errors) {
    std::vector<Weighted> list;
    list.reserve(errors.size());
    for (const double error : errors)
        list.push_back(weigh(error, 1));
    return summarize_weighted(std::move(list));
}

std::optional<ErrorSummary> summarize(std::span<const ErrorCluster> clusters) {
    std::vector<Weighted> list;
    for (const ErrorCluster& cluster : clusters) {
        for (const double error : cluster.errors)
            list.push_back(weigh(error, cluster.weight));
    }
    return summarize_weighted(std::move(list));
}

double StatusCounts::share() const {
    if (compared == 0) return 0;
    return static_cast<double>(disagreeing) / static_cast<double>(compared);
}

StatusCounts& StatusCounts::operator+=(const StatusCounts& other) {
    compared += other.compared;
    disagreeing += other.disagreeing;
    return *this;
}

}  // namespace stormcellar::accuracy
