// stormcellar/accuracy/error_statistics.h -- what a list of errors amounts to.
//
// These are the figures OF the errors given. What a sample of errors says about all of them is in
// accuracy/quantile_bound.h; the two must not be mistaken for each other.
// Errors are signed, in any one unit; all figures are of their magnitudes. An error that is NaN
// counts as infinite, so that it hides nothing.
// Thread contract: pure functions.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace stormcellar::accuracy {

// Errors that may depend on each other, such as those of the cells of one column. Different
// clusters of a sample are drawn independently of each other.
struct ErrorCluster {
    std::vector<double> errors;
    double weight = 1;  // clusters of the whole that it stands for, in any one scale; above 0
};

struct ErrorSummary {
    std::size_t count = 0;
    double rms = 0, p95 = 0, p99 = 0, max = 0;
};

// A quantile q is the smallest error that at least q of the (weighted) errors do not exceed: it is
// always one of them. None when there are no errors.
[[nodiscard]] std::optional<ErrorSummary> summarize(std::span<const double> errors);
[[nodiscard]] std::optional<ErrorSummary> summarize(std::span<const ErrorCluster> clusters);

// Cells whose status (value, no echo, not seen, range folded) was compared, and how many differed.
// Counted apart: an error of a value exists only where both have one.
struct StatusCounts {
    std::uint64_t compared = 0;
    std::uint64_t disagreeing = 0;

    // 0 when nothing was compared.
    [[nodiscard]] double share() const;
    StatusCounts& operator+=(const StatusCounts& other);
    bool operator==(const StatusCounts&) const = default;
};

}  // namespace stormcellar::accuracy
