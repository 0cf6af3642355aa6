// stormcellar/accuracy/error_statistics.h -- figures that summarize a list of errors.
//
// The figures describe the given errors only; accuracy/quantile_bound.h draws conclusions from a
// sample about all errors. Errors are signed; all figures describe their magnitudes. A NaN counts
// as an infinite error, so that it stays visible.
//
// Units     All errors of a list, and its figures, are in one unit of the caller's choice.
// Threads   Pure functions and plain values.
// Errors    None; an empty list has no summary.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace stormcellar::accuracy {

// Errors that may depend on each other, such as the errors of all cells of one column. The clusters
// of a sample must have been drawn independently of each other.
struct ErrorCluster {
    std::vector<double> errors;
    double weight = 1;  // number of clusters that this cluster represents, in any scale; above 0
};

struct ErrorSummary {
    std::size_t count = 0;
    double rms = 0, p95 = 0, p99 = 0, max = 0;
};

// Returns the figures, or none without errors. The quantile q is the smallest error in the list for
// which at least a share q of the (weighted) errors is as small or smaller.
[[nodiscard]] std::optional<ErrorSummary> summarize(std::span<const double> errors);
[[nodiscard]] std::optional<ErrorSummary> summarize(std::span<const ErrorCluster> clusters);

// The number of cells whose status (value, no echo, not seen, range folded) was compared, and the
// number of cells where it differed. Status is counted separately, because a cell has an error only
// if both of the compared results have a value there.
struct StatusCounts {
    std::uint64_t compared = 0;
    std::uint64_t disagreeing = 0;

    // Returns the share of compared cells that disagree, or 0 if no cell was compared.
    [[nodiscard]] double share() const;
    StatusCounts& operator+=(const StatusCounts& other);
    bool operator==(const StatusCounts&) const = default;
};

}  // namespace stormcellar::accuracy
