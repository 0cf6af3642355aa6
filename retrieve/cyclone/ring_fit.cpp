#include "retrieve/cyclone/ring_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <tuple>
#include <vector>

namespace stormcellar::retrieve {
namespace {

constexpr std::size_t most_numbers = std::tuple_size_v<RingSeries>;
constexpr double most_reach = 0.9;       // of a circle toward the radar
constexpr double least_outlier_mps = 5;  // smaller residuals are never dropped
using Numbers = RingSeries;
using Matrix = std::array<Numbers, most_numbers>;

// Returns 1 and the cosine and sine of once, twice and three times an angle.
Numbers terms_of(double cosine, double sine) {
    Numbers terms{1, cosine, sine};
    for (std::size_t wave = 2; wave <= 3; ++wave) {
        const double c = terms[2 * wave - 3], s = terms[2 * wave - 2];
        terms[2 * wave - 1] = c * cosine - s * sine;
        terms[2 * wave] = s * cosine + c * sine;
    }
    return terms;
}

struct Point {
    std::size_t index = 0;  // around the circle
    double value = 0;       // velocity * D / RT
    Numbers terms{};
    double residual = 0;
};

// Returns the inverse of the first `size` rows and columns of a positive definite matrix, by Gauss
// and Jordan. Returns none if the points do not determine all numbers.
std::optional<Matrix> inverse(Matrix matrix, std::size_t size) {
    Matrix result{};
    for (std::size_t i = 0; i < size; ++i)
        result[i][i] = 1;
    for (std::size_t i = 0; i < size; ++i) {
        const double pivot = matrix[i][i];
        if (!(pivot > 1e-3)) return std::nullopt;
        for (std::size_t j = 0; j < size; ++j) {
            matrix[i][j] /= pivot;
            result[i][j] /= pivot;
        }
        for (std::size_t row = 0; row < size; ++row) {
            if (row == i) continue;
            const double factor = matrix[row][i];
            for (std::size_t j = 0; j < size; ++j) {
                matrix[row][j] -= factor * matrix[i][j];
                result[row][j] -= factor * result[i][j];
            }
        }
    }
    return result;
}

struct Solution {
    Numbers numbers{};
    Matrix covariance{};  // for residuals of variance 1
    double variance = 0;  // of the residuals
};

std::optional<Solution> solve(std::vector<Point>& points, std::size_t size) {
    if (points.size() < 2 * size) return std::nullopt;
    Matrix matrix{};
    Numbers right{};
    for (const Point& point : points) {
        for (std::size_t i = 0; i < size; ++i) {
            right[i] += point.terms[i] * point.value;
            for (std::size_t j = 0; j < size; ++j)
                matrix[i][j] += point.terms[i] * point.terms[j];
        }
    }
    const auto covariance = inverse(matrix, size);
    if (!covariance) return std::nullopt;
    Solution solution;
    solution.covariance = *covariance;
    for (std::size_t i = 0; i < size; ++i)
        for (std::size_t j = 0; j < size; ++j)
            solution.numbers[i] += solution.covariance[i][j] * right[j];
    for (Point& point : points) {
        point.residual = point.value;
        for (std::size_t i = 0; i < size; ++i)
            point.residual -= solution.numbers[i] * point.terms[i];
        solution.variance += point.residual * point.residual;
    }
    solution.variance /= static_cast<double>(points.size() - size);
    return solution;
}

std::vector<Point> points_of(const PolarVelocity& field, const RingRequest& request) {
    const grid::PlanePoint center = request.center;
    const double distance = std::hypot(center.x_m, center.y_m);
    const double east = center.x_m / distance, north = center.y_m / distance;
    std::vector<Point> points;
    points.reserve(static_cast<std::size_t>(request.samples));
    for (int i = 0; i < request.samples; ++i) {
        const double angle = 2 * std::numbers::pi * i / request.samples;
        const double cosine = std::cos(angle), sine = std::sin(angle);
        const double x = center.x_m + request.radius_m * (cosine * east - sine * north);
        const double y = center.y_m + request.radius_m * (cosine * north + sine * east);
        const double share = std::hypot(x, y) / distance;
        const double velocity =
            request.expected == nullptr
                ? field.at(x, y)
                : field.at(x, y, series_at(*request.expected, cosine, sine) / share);
        if (std::isnan(velocity)) continue;
        points.push_back(
            {static_cast<std::size_t>(i), velocity * share, terms_of(cosine, sine), 0});
    }
    return points;
}

double largest_gap_deg(const std::vector<Point>& points, int samples) {
    std::size_t widest = static_cast<std::size_t>(samples);
    if (!points.empty()) {
        widest = points.front().index + static_cast<std::size_t>(samples) - points.back().index;
        for (std::size_t i = 1; i < points.size(); ++i)
            widest = std::max(widest, points[i].index - points[i - 1].index);
    }
    return 360.0 * static_cast<double>(widest) / samples;
}

int waves_of_gap(double gap_deg) {
    if (gap_deg <= 30) return 3;
    if (gap_deg <= 60) return 2;
    return gap_deg <= 90 ? 1 : 0;
}

// Returns 1.4826 times the median magnitude of the residuals, which a few bad points hardly change.
double deviation_of(const std::vector<Point>& points) {
    std::vector<double> sizes;
    sizes.reserve(points.size());
    for (const Point& point : points)
        sizes.push_back(std::abs(point.residual));
    const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
    std::ranges::nth_element(sizes, middle);
    return 1.4826 * *middle;
}

// Fits the points, drops points that are far off, and fits again, until no point is far off.
std::optional<Solution> solve_robustly(std::vector<Point>& points, std::size_t size) {
    for (;;) {
        auto solution = solve(points, size);
        if (!solution) return std::nullopt;
        const double most = std::max(3.5 * deviation_of(points), least_outlier_mps);
        const auto is_far = [&](const Point& point) { return std::abs(point.residual) > most; };
        if (std::erase_if(points, is_far) == 0) return solution;
    }
}

// Returns the factor by which correlation between neighboring points enlarges the variance of a
// fitted number.
double correlation_factor(const std::vector<Point>& points) {
    double products = 0, squares = 0;
    for (std::size_t i = 1; i < points.size(); ++i) {
        products += points[i].residual * points[i - 1].residual;
        squares += points[i].residual * points[i].residual;
    }
    if (!(squares > 0)) return 1;
    const double correlation = std::clamp(products / squares, 0.0, 0.9);
    return (1 + correlation) / (1 - correlation);
}

// Returns the standard error of the sum of weights * numbers.
double error_of(const Solution& solution, const Numbers& weights, double variance) {
    double sum = 0;
    for (std::size_t i = 0; i < most_numbers; ++i)
        for (std::size_t j = 0; j < most_numbers; ++j)
            sum += weights[i] * weights[j] * solution.covariance[i][j];
    return std::sqrt(std::max(0.0, sum * variance));
}

double value_of(const Solution& solution, const Numbers& weights) {
    double sum = 0;
    for (std::size_t i = 0; i < most_numbers; ++i)
        sum += weights[i] * solution.numbers[i];
    return sum;
}

}  // namespace

double series_at(const RingSeries& series, double cosine, double sine) {
    const Numbers terms = terms_of(cosine, sine);
    double sum = 0;
    for (std::size_t i = 0; i < most_numbers; ++i)
        sum += series[i] * terms[i];
    return sum;
}

std::optional<RingFit> fit_ring(const PolarVelocity& field, const RingRequest& request) {
    const double distance = std::hypot(request.center.x_m, request.center.y_m);
    if (!(request.radius_m > 0 && request.radius_m < most_reach * distance)) return std::nullopt;
    const double r = request.radius_m / distance;
    std::vector<Point> points = points_of(field, request);
    RingFit fit;
    fit.coverage = static_cast<double>(points.size()) / request.samples;
    fit.largest_gap_deg = largest_gap_deg(points, request.samples);
    fit.waves = std::min(waves_of_gap(fit.largest_gap_deg), request.most_waves);
    if (fit.waves < 1) return std::nullopt;
    const auto size = static_cast<std::size_t>(2 * fit.waves + 1);
    const std::size_t all = points.size();
    const auto solution = solve_robustly(points, size);
    if (!solution || points.size() < all * 3 / 4) return std::nullopt;

    // Combine the coefficients, in the order a0 a1 b1 a2 b2 a3 b3. Waves that were not fitted are
    // 0.
    const double share = 1 / (1 - r * r);
    const Numbers tangential{0, 0, -1, 0, 0, 0, -1};
    const Numbers radial{-r * share, share, 0, -r * share, 0, share, 0};
    const Numbers along{share, -r * share, 0, share, 0, -r * share, 0};
    const double variance = solution->variance * correlation_factor(points);
    fit.series = solution->numbers;
    fit.tangential_mps = request.rotation * value_of(*solution, tangential);
    fit.radial_mps = value_of(*solution, radial);
    fit.along_mps = value_of(*solution, along);
    fit.wave1_mps = 2 * std::hypot(solution->numbers[3], solution->numbers[4]);
    fit.tangential_error_mps = error_of(*solution, tangential, variance);
    fit.radial_error_mps = error_of(*solution, radial, variance);
    fit.along_error_mps = error_of(*solution, along, variance);
    fit.residual_mps = std::sqrt(solution->variance);
    return fit;
}

}  // namespace stormcellar::retrieve
