// accuracy/quantile_bound.h -- bounds a quantile of all errors from a sample of errors.
//
// The functions return an upper confidence bound of a quantile; the bound is one of the sampled
// magnitudes. If sampling is repeated, the bound is below the true quantile of the magnitudes of
// all errors in at most a share 1 - confidence of the samples. This holds for every distribution
// (heavy tails, ties, mixtures). The true quantile is the smallest t that at most a share 1 -
// quantile of the errors exceeds. If the sample is too small to bound the quantile, the functions
// return none; they never extrapolate. A NaN counts as infinite.
//
// Accuracy  tests/accuracy/quantile_bound_test.cpp enforces the coverage on simulations with known
//           truth.
// Threads   Pure functions.
#pragma once

#include <optional>
#include <span>

#include "stormcellar/accuracy/error_statistics.h"

namespace stormcellar::accuracy {

struct BoundRequest {
    double quantile = 0.99;     // above 0 and below 1, else there is no bound
    double confidence = 0.999;  // above 0 and below 1, else there is no bound
};

// Bounds errors that are drawn independently of each other. The bound is the order statistic of the
// binomial distribution (exact, e.g. Conover 1999, section 3.2). The 99th percentile at 99.9 %
// needs 688 errors.
[[nodiscard]] std::optional<double> quantile_upper_bound(std::span<const double> errors,
                                                         const BoundRequest& request);

// Bounds errors in clusters, such as the columns of a grid. Only the clusters are independent; all
// cells of one cluster may be off together. Clusters may be empty, may differ in size, and may be
// drawn without replacement. The size of a cluster may depend on its errors. Some clusters may be
// drawn more often than others, if their weights make up for the difference:
//   strata        Fix beforehand how many clusters to draw from each stratum; weight = (clusters in
//                 the stratum) / (clusters drawn from it).
//   proportional  Draw with replacement, in proportion to a size that is known for all clusters,
//                 such as the number of cells in which the cheap form has a value; weight = 1 /
//                 size.
// `most_weight` is the largest possible (weight * errors) of any cluster that could have been
// drawn. Pass a number that is known beforehand, not a number taken from the sample; for columns
// with weight 1, pass the number of levels. If a cluster exceeds `most_weight`, there is no bound.
//
// The method bets that t is at least the quantile. A cluster with weight w and m errors, of which k
// exceed t, multiplies the stake by 1 - l w (k - (1 - quantile) m), where l is a constant. If t
// were below the quantile, the expected stake would not grow (for strata by the inequality of the
// means). So by Markov's inequality the stake reaches 1 / (1 - confidence) with a probability of at
// most 1 - confidence. The stake is shared among eight values of l. (After Waudby-Smith and Ramdas
// 2024, "Estimating means of bounded random variables by betting".)
//
// The 99th percentile at 99.9 % needs 902 clusters whose (weight * errors) is most_weight, or ten
// times as many clusters with a tenth of most_weight. So draw columns in proportion to the number
// of errors that they may hold.
[[nodiscard]] std::optional<double> quantile_upper_bound(std::span<const ErrorCluster> clusters,
                                                         double most_weight,
                                                         const BoundRequest& request);

}  // namespace stormcellar::accuracy
