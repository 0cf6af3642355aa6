// retrieve/quality/additive_rule.h -- the rules that turn features of a gate into the probability
// of weather.
//
// The log-odds of weather are a constant plus one number for each feature. That number is linear
// between knots and constant beyond the first and the last knot. A missing feature has a number of
// its own.
//
// Accuracy  RuleTables rounds a feature to 1/511 of the distance between the outer knots.
// Threads   Plain data and const functions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "retrieve/quality/echo_features.h"

namespace stormcellar::retrieve {

struct Knot {
    float at = 0;
    float log_odds = 0;
};

struct RuleTerm {
    Feature feature = Feature::reflectivity;
    float missing = 0;  // log-odds
    std::span<const Knot> knots;
};

struct AdditiveRule {
    float constant = 0;
    std::span<const RuleTerm> terms;
};

// The rules that bench/teach_quality.cpp printed (taught_rules.cpp).
[[nodiscard]] const AdditiveRule& taught_rule(QualityRule rule);

// The terms of a rule as tables at equal steps, which are faster than a search among the knots.
class RuleTables {
  public:
    explicit RuleTables(const AdditiveRule& rule);

    [[nodiscard]] float constant() const { return constant_; }
    // Adds the log-odds of a feature's values. The rule must have the feature.
    void add(Feature feature, std::span<const float> values, float* log_odds) const;

  private:
    static constexpr std::size_t steps = 512;
    static constexpr std::int32_t last_step = steps - 1;
    struct Table {
        float first = 0, steps_per_unit = 0;
        std::array<float, steps + 1> log_odds{};  // the last entry is that of a missing value
    };
    float constant_;
    std::vector<Table> tables_;
    std::array<std::size_t, feature_count> table_of_{};
};

}  // namespace stormcellar::retrieve
