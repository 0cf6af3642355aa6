// stormcellar/accuracy/error_statistics.h -- figures that sum up a list of errors.
//
// The figures describe the given errors. To draw conclusions from a sample about all errors, use
// accuracy/quantile_bound.h; do not mistake one for the other. Errors are signed; all figures
// describe their magnitudes. An error that is NaN counts as infinite, so that it hides nothing.
//
// Units     All errors of a list, and its figures, are in one unit of the caller's choice.
// Threads   Pure functions and plain values.
// Errors    None; a list without errors has no summary.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace stormcellar::accuracy {

// Errors that may depend on each other, such as those of the cells of one column. The clusters of a
// sample must have been drawn independently of each other.
struct ErrorCluster {
    std::vector<double> errors;
    double weight = 1;  // number of clusters that this one represents, in any one scale; above 0
};

struct ErrorSummary {
    std::size_t count = 0;
    double rms = 0, p95 = 0, p99 = 0, max = 0;
};

// Returns the figures, or none if there are no errors. The quantile q is the smallest error that at
// least a share q of the (weighted) errors does not exceed, so it is always one of the errors.
[[nodiscard]] std::optional<ErrorSummary> summarize(std::span<const double> errors);
[[nodiscard]] std::optional<ErrorSummary> summarize(std::span<const ErrorCluster> clusters);

// Number of cells whose status (value, no echo, not seen, range folded) was compared, and number
// that differed. They are counted separately, because a value has an error only if both sides have
// a value.
struct StatusCounts {
    std::uint64_t compared = 0;
    std::uint64_t disagreeing = 0;

    // Returns the share of cells that disagree, or 0 if nothing was compared.
    [[nodiscard]] double share() const;
    StatusCounts& operator+=(const StatusCounts& other);
    bool operator==(const StatusCounts&) const = default;
};

}  // namespace stormcellar::accuracy
