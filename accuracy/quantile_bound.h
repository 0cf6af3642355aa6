// accuracy/quantile_bound.h -- what a sample proves about the errors that were not looked at.
//
// An upper confidence bound of a quantile: over repeated samples it lies below the true quantile of
// all errors' magnitudes in at most a share of 1 - confidence of them, whatever the distribution
// (heavy tails, ties, mixtures). It is one of the sampled magnitudes. None when the sample is too
// small to bound the quantile at all; nothing is ever extrapolated. The true quantile is the
// smallest t that at most a share 1 - quantile of the errors exceed. A NaN counts as infinite.
//
// Coverage is enforced by tests/accuracy/quantile_bound_test.cpp on simulations with known truth.
// Thread contract: pure functions.
#pragma once

#include <optional>
#include <span>

#include "stormcellar/accuracy/error_statistics.h"

namespace stormcellar::accuracy {

struct BoundRequest {
    double quantile = 0.99;     // above 0 and below 1, else there is no bound
    double confidence = 0.999;  // likewise
};

// For errors drawn independently of each other: the order statistic of the binomial distribution
// (exact, e.g. Conover 1999, section 3.2). The 99th percentile at 99.9 % needs 688 errors.
[[nodiscard]] std::optional<double> quantile_upper_bound(std::span<const double> errors,
                                                         const BoundRequest& request);

// For errors in clusters, such as the columns of a grid: only clusters are independent, cells of
// one may all be off together. Clusters may be empty, differ in size, depend in size on how far
// they are off, and be drawn without replacement. The sample may favour some of them:
//   strata        fix beforehand how many clusters each gives; weight = (clusters in the stratum) /
//                 (clusters drawn from it)
//   in proportion to a size known for all, such as the cells that the cheap form has a value in,
//                 with replacement; weight = 1 / size
// `most_weight` is the most that (weight * errors) of any cluster that could have been drawn can
// be; it must be known beforehand and not read off the sample. Without weights it is the number of
// levels. A cluster beyond it: no bound.
//
// Method: a wager that t is at least the quantile. A cluster of m errors of which k exceed t, of
// weight w, multiplies the stake by 1 - l w (k - (1 - quantile) m). Were t below the quantile, the
// expected stake would not grow (for strata by the inequality of the means); so by Markov's
// inequality it reaches 1 / (1 - confidence) with a probability of at most 1 - confidence. The
// stake is shared among eight values of l. (After Waudby-Smith and Ramdas 2024, "Estimating means
// of bounded random variables by betting".)
// The price: the 99th percentile at 99.9 % needs 902 clusters that are as heavy as most_weight, ten
// times as many when they have a tenth of it. So draw columns in proportion to what they hold.
[[nodiscard]] std::optional<double> quantile_upper_bound(std::span<const ErrorCluster> clusters,
                                                         double most_weight,
                                                         const BoundRequest& request);

}  // namespace stormcellar::accuracy
