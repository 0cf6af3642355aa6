// bench/additive_fit.h -- fits the rules of retrieve/quality/additive_rule.h to gates whose kind is
// known.
//
// Threads   Pure functions; print_rule() writes to standard output.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "retrieve/quality/echo_features.h"
#include "stormcellar/retrieve/quality.h"

namespace stormcellar::bench {

struct Lesson {
    std::array<float, retrieve::feature_count> features{};
    bool is_weather = false;
    bool is_strong = false;  // weather of at least 20 dBZ
    double weight = 1;
};

struct FittedTerm {
    retrieve::Feature feature = retrieve::Feature::reflectivity;
    std::vector<double> knots, log_odds;
    double missing = 0;
};
struct FittedRule {
    double constant = 0;
    std::vector<FittedTerm> terms;
};

// Fits a rule by logistic regression with a ridge. Weather and other echo weigh the same in total.
// The constant is moved so that 1.5 % of the strong weather of the lessons gets less than 0.5.
[[nodiscard]] FittedRule fit_rule(std::vector<Lesson> lessons, retrieve::QualityRule rule);

// Prints a rule as C++.
void print_rule(std::string_view name, const FittedRule& rule);

}  // namespace stormcellar::bench
