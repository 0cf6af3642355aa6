#include "bench/additive_fit.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <span>
#include <utility>

#include <fmt/core.h>

namespace stormcellar::bench {
namespace {

using retrieve::Feature;
using retrieve::QualityRule;

struct FeatureKnots {
    Feature feature;
    std::vector<double> knots;
};

std::vector<FeatureKnots> knots_of(QualityRule rule) {
    const std::vector<double> dbz = {-20, -10, -5, 0, 5, 10, 15, 20, 25, 30, 40, 50};
    const std::vector<double> db = {0, 1, 2, 3, 4, 5, 7, 10};
    const std::vector<double> share = {0, 0.1, 0.2, 0.4, 0.6, 0.8, 0.95, 1};
    const std::vector<double> mps = {0, 0.5, 1, 1.5, 2, 3, 4, 6, 10};
    if (rule == QualityRule::dual)
        return {{Feature::reflectivity, dbz},
                {Feature::correlation,
                 {0.2, 0.4, 0.6, 0.7, 0.75, 0.8, 0.85, 0.9, 0.93, 0.95, 0.97, 0.99, 1.05}},
                {Feature::zdr_texture, {0, 0.25, 0.5, 1, 1.5, 2, 3, 4, 6, 8}},
                {Feature::phase_texture, {0, 2, 4, 7, 10, 15, 20, 30, 50, 80}}};
    return {{Feature::reflectivity, dbz},
            {Feature::height, {0, 250, 500, 1000, 1500, 2000, 3000, 4000, 6000, 8000, 12000}},
            {Feature::range_texture, db},
            {Feature::azimuth_texture, db},
            {Feature::echo_share, share},
            {Feature::mean_reflectivity, dbz},
            {Feature::reflectivity_above, dbz},
            {Feature::speed, {0, 0.5, 1, 2, 3, 5, 10, 20, 30}},
            {Feature::speed_texture, mps},
            {Feature::width, mps},
            {Feature::speed_share, share}};
}

// The columns of one lesson that are not 0.
struct SparseRow {
    std::array<std::pair<std::size_t, double>, 2 * retrieve::feature_count + 1> entries;
    std::size_t count = 0;
    void add(std::size_t column, double value) { entries[count++] = {column, value}; }
    [[nodiscard]] std::span<const std::pair<std::size_t, double>> all() const {
        return std::span(entries).first(count);
    }
};

class Design {
  public:
    explicit Design(const std::vector<FeatureKnots>& features) : features_(features) {
        for (const FeatureKnots& feature : features) {
            begins_.push_back(columns_);
            columns_ += feature.knots.size() + 1;
        }
    }
    // Column 0 is the constant; each feature has a column for each knot, and a column for a missing
    // value.
    [[nodiscard]] std::size_t columns() const { return columns_; }
    [[nodiscard]] std::size_t begin(std::size_t term) const { return begins_[term]; }

    [[nodiscard]] SparseRow row_of(const Lesson& lesson) const {
        SparseRow row;
        row.add(0, 1);
        for (std::size_t term = 0; term < features_.size(); ++term) {
            const auto& knots = features_[term].knots;
            const auto value = static_cast<double>(
                lesson.features[static_cast<std::size_t>(features_[term].feature)]);
            if (std::isnan(value)) {
                row.add(begins_[term] + knots.size(), 1);
                continue;
            }
            const double inside = std::clamp(value, knots.front(), knots.back());
            const auto after =
                std::clamp<std::ptrdiff_t>(std::ranges::upper_bound(knots, inside) - knots.begin(),
                                           1, static_cast<std::ptrdiff_t>(knots.size()) - 1);
            const auto i = static_cast<std::size_t>(after);
            const double share = (inside - knots[i - 1]) / (knots[i] - knots[i - 1]);
            row.add(begins_[term] + i - 1, 1 - share);
            row.add(begins_[term] + i, share);
        }
        return row;
    }

  private:
    const std::vector<FeatureKnots>& features_;
    std::vector<std::size_t> begins_;
    std::size_t columns_ = 1;
};

double log_odds_of(const SparseRow& row, const std::vector<double>& weights) {
    double sum = 0;
    for (const auto& [column, value] : row.all())
        sum += weights[column] * value;
    return sum;
}

// Solves a positive definite system by Cholesky's method; `matrix` is destroyed.
std::vector<double> solved(std::vector<double>& matrix, std::vector<double> right) {
    const std::size_t n = right.size();
    const auto at = [&](std::size_t i, std::size_t j) -> double& { return matrix[i * n + j]; };
    for (std::size_t j = 0; j < n; ++j) {
        for (std::size_t k = 0; k < j; ++k)
            at(j, j) -= at(j, k) * at(j, k);
        at(j, j) = std::sqrt(at(j, j));
        for (std::size_t i = j + 1; i < n; ++i) {
            for (std::size_t k = 0; k < j; ++k)
                at(i, j) -= at(i, k) * at(j, k);
            at(i, j) /= at(j, j);
        }
    }
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t k = 0; k < i; ++k)
            right[i] -= at(i, k) * right[k];
        right[i] /= at(i, i);
    }
    for (std::size_t i = n; i-- > 0;) {
        for (std::size_t k = i + 1; k < n; ++k)
            right[i] -= at(k, i) * right[k];
        right[i] /= at(i, i);
    }
    return right;
}

// Gives weather and other echo the same weight, and the lessons a mean weight of 1.
void balance(std::vector<Lesson>& lessons) {
    std::array<double, 2> sums{};
    for (const Lesson& lesson : lessons)
        sums[lesson.is_weather ? 1 : 0] += lesson.weight;
    for (Lesson& lesson : lessons)
        lesson.weight *=
            static_cast<double>(lessons.size()) / (2 * sums[lesson.is_weather ? 1 : 0]);
}

std::vector<double> fit_weights(const std::vector<Lesson>& lessons, const Design& design) {
    constexpr double ridge = 10;
    constexpr int most_steps = 12;
    const std::size_t n = design.columns();
    std::vector<double> weights(n, 0);
    for (int step = 0; step < most_steps; ++step) {
        std::vector<double> matrix(n * n, 0), gradient(n, 0);
        for (std::size_t i = 0; i < n; ++i) {
            matrix[i * n + i] = i == 0 ? 1e-6 : ridge;
            gradient[i] = -matrix[i * n + i] * weights[i];
        }
        for (const Lesson& lesson : lessons) {
            const SparseRow row = design.row_of(lesson);
            const double probability = 1 / (1 + std::exp(-log_odds_of(row, weights)));
            const double error = lesson.weight * ((lesson.is_weather ? 1 : 0) - probability);
            const double curvature = lesson.weight * probability * (1 - probability);
            for (const auto& [i, a] : row.all()) {
                gradient[i] += error * a;
                for (const auto& [j, b] : row.all())
                    if (j <= i) matrix[i * n + j] += curvature * a * b;
            }
        }
        const std::vector<double> change = solved(matrix, std::move(gradient));
        for (std::size_t i = 0; i < n; ++i)
            weights[i] += change[i];
    }
    return weights;
}

// Returns the log-odds below which 1.5 % of the strong weather lies. Every volume weighs the same.
double strong_percentile(const std::vector<Lesson>& lessons, const Design& design,
                         const std::vector<double>& weights) {
    std::vector<double> strong;
    for (const Lesson& lesson : lessons)
        if (lesson.is_strong) strong.push_back(log_odds_of(design.row_of(lesson), weights));
    const auto at = strong.begin() + static_cast<std::ptrdiff_t>(strong.size() * 15 / 1000);
    std::ranges::nth_element(strong, at);
    return *at;
}

}  // namespace

FittedRule fit_rule(std::vector<Lesson> lessons, QualityRule rule) {
    balance(lessons);
    const std::vector<FeatureKnots> features = knots_of(rule);
    const Design design(features);
    const std::vector<double> weights = fit_weights(lessons, design);
    FittedRule fitted;
    fitted.constant = weights[0] - strong_percentile(lessons, design, weights);
    for (std::size_t term = 0; term < features.size(); ++term) {
        const auto begin = weights.begin() + static_cast<std::ptrdiff_t>(design.begin(term));
        const auto end = begin + static_cast<std::ptrdiff_t>(features[term].knots.size());
        fitted.terms.push_back({features[term].feature, features[term].knots, {begin, end}, *end});
    }
    return fitted;
}

void print_rule(std::string_view name, const FittedRule& rule) {
    for (const FittedTerm& term : rule.terms) {
        fmt::print("constexpr std::array {}_{} = {{\n", name, feature_name(term.feature));
        for (std::size_t i = 0; i < term.knots.size(); ++i)
            fmt::print("Knot{{{:.2f}F, {:.3f}F}},{}", term.knots[i], term.log_odds[i],
                       i + 1 == term.knots.size() ? "\n" : " ");
        fmt::print("}};\n");
    }
    fmt::print("constexpr std::array {}_terms = {{\n", name);
    for (const FittedTerm& term : rule.terms)
        fmt::print("RuleTerm{{Feature::{0}, {1:.3f}F, {2}_{0}}},\n", feature_name(term.feature),
                   term.missing, name);
    fmt::print("}};\nconstexpr AdditiveRule {0}_rule{{{1:.3f}F, {0}_terms}};\n\n", name,
               rule.constant);
}

}  // namespace stormcellar::bench
