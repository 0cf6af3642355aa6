#include "retrieve/wind/vvp_fit.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace stormcellar::retrieve {
namespace {

constexpr std::size_t least_gates = 30;
constexpr int least_gates_of_sector = 3;
constexpr double most_gap_deg = 120;
constexpr double least_used_share = 0.5;
// Noise that is spread evenly over the Nyquist interval has an rms of 0.58 Nyquist velocities.
constexpr double most_rms_per_nyquist = 0.4;
// An rms above the first limit is allowed in strong winds only, where the fit explains three
// quarters of the variance: mixtures of clutter and wind have such an rms, too.
constexpr double greatest_rms_mps = 3.5, most_rms_per_speed = 0.4;
constexpr double rejection_deviations = 3;
constexpr double least_rejection_mps = 1.5;  // above the steps in which a radar sends velocities
constexpr double deviation_per_median = 1.4826;
// Ground clutter, and the air where it is calm, move less than this.
constexpr float least_moving_mps = 1;
constexpr int most_rounds = 20, rounds_by_sizes = 15;
constexpr double least_size_mps = 0.5;
constexpr double least_pivot = 1e-6;  // for each gate

using Vector3 = std::array<double, 3>;  // of u, v, w
using Matrix3 = std::array<Vector3, 3>;

Vector3 beam_of(const VvpGate& gate) {
    return {static_cast<double>(gate.east), static_cast<double>(gate.north),
            static_cast<double>(gate.up)};
}

double residual(const VvpGate& gate, const Vector3& wind) {
    const Vector3 beam = beam_of(gate);
    return static_cast<double>(gate.velocity_mps) - beam[0] * wind[0] - beam[1] * wind[1] -
           beam[2] * wind[2];
}

struct Solution {
    Vector3 wind{};
    Matrix3 inverse{};  // of the normal matrix; zeros for w if the beams are level
    bool has_w = false;
};

// Inverts the leading `size` rows and columns by elimination. Returns false if they are singular.
bool invert(Matrix3 matrix, std::size_t size, double least, Matrix3& inverse) {
    inverse = {};
    for (std::size_t i = 0; i < size; ++i)
        inverse[i][i] = 1;
    for (std::size_t i = 0; i < size; ++i) {
        const double pivot = matrix[i][i];
        if (!(pivot > least)) return false;
        for (std::size_t k = 0; k < size; ++k) {
            matrix[i][k] /= pivot;
            inverse[i][k] /= pivot;
        }
        for (std::size_t j = 0; j < size; ++j) {
            if (j == i) continue;
            const double factor = matrix[j][i];
            for (std::size_t k = 0; k < size; ++k) {
                matrix[j][k] -= factor * matrix[i][k];
                inverse[j][k] -= factor * inverse[i][k];
            }
        }
    }
    return true;
}

// Solves the least-squares problem of the weighted gates. Returns none if the gates cannot tell u
// from v.
template <class Weight>
std::optional<Solution> solve(std::span<const VvpGate> gates, const std::vector<Weight>& weights) {
    Matrix3 normal{};
    Vector3 right{};
    double count = 0;
    for (std::size_t n = 0; n < gates.size(); ++n) {
        const auto weight = static_cast<double>(weights[n]);
        const Vector3 beam = beam_of(gates[n]);
        for (std::size_t i = 0; i < 3; ++i) {
            right[i] += weight * beam[i] * static_cast<double>(gates[n].velocity_mps);
            for (std::size_t j = 0; j < 3; ++j)
                normal[i][j] += weight * beam[i] * beam[j];
        }
        count += weight;
    }
    Solution found;
    found.has_w = invert(normal, 3, least_pivot * count, found.inverse);
    if (!found.has_w && !invert(normal, 2, least_pivot * count, found.inverse)) return std::nullopt;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            found.wind[i] += found.inverse[i][j] * right[j];
    return found;
}

bool is_moving(const VvpGate& gate) {
    return std::abs(gate.velocity_mps) > least_moving_mps;
}

// Finds the wind whose sum of absolute residuals is nearly the smallest, by weighting each gate
// with the inverse of its residual. If a sixth of the gates do not move with the wind, the result
// hardly changes, even if they are all in one direction. Gates that do not move have no weight
// here, because clutter may be most of a layer. Where the wind is across the beam, reject() accepts
// such gates.
std::optional<Solution> solve_by_sizes(std::span<const VvpGate> gates) {
    std::vector<float> weights;
    weights.reserve(gates.size());
    for (const VvpGate& gate : gates)
        weights.push_back(is_moving(gate) ? 1 : 0);
    std::optional<Solution> solution = solve(gates, weights);
    for (int round = 1; solution && round < rounds_by_sizes; ++round) {
        for (std::size_t n = 0; n < gates.size(); ++n) {
            if (weights[n] == 0) continue;
            const double size = std::abs(residual(gates[n], solution->wind));
            weights[n] = static_cast<float>(1 / std::max(size, least_size_mps));
        }
        solution = solve(gates, weights);
    }
    return solution;
}

// Marks the gates within three deviations of the wind, where the deviation is estimated from the
// median residual of the gates that move; there must be one. Returns true if the marks changed.
bool reject(std::span<const VvpGate> gates, const Vector3& wind,
            std::vector<std::uint8_t>& was_used) {
    std::vector<double> sizes, sorted;
    sizes.reserve(gates.size());
    for (const VvpGate& gate : gates) {
        sizes.push_back(std::abs(residual(gate, wind)));
        if (is_moving(gate)) sorted.push_back(sizes.back());
    }
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::ranges::nth_element(sorted, middle);
    const double most =
        std::max(rejection_deviations * deviation_per_median * *middle, least_rejection_mps);
    bool has_changed = false;
    for (std::size_t n = 0; n < gates.size(); ++n) {
        const std::uint8_t use = sizes[n] <= most ? 1 : 0;
        has_changed |= use != was_used[n];
        was_used[n] = use;
    }
    return has_changed;
}

double largest_gap_deg(std::span<const VvpGate> gates, const std::vector<std::uint8_t>& was_used) {
    std::array<int, VvpGate::sectors> counts{};
    for (std::size_t n = 0; n < gates.size(); ++n)
        counts[gates[n].sector] += was_used[n];
    // Go around twice, so that a gap across north counts as a whole.
    int longest = 0, run = 0;
    for (int i = 0; i < 2 * VvpGate::sectors; ++i) {
        const int count = counts[static_cast<std::size_t>(i % VvpGate::sectors)];
        run = count < least_gates_of_sector ? run + 1 : 0;
        longest = std::max(longest, std::min(run, VvpGate::sectors));
    }
    return longest * 360.0 / VvpGate::sectors;
}

// Computes rms and standard errors. The residuals within a sector add up before they are squared,
// so that errors that the gates of the sector share count in full.
void add_errors(std::span<const VvpGate> gates, const Solution& solution, VvpFit& fit) {
    std::array<Vector3, VvpGate::sectors> sums{};
    double squares = 0;
    for (std::size_t n = 0; n < gates.size(); ++n) {
        if (fit.was_used[n] == 0) continue;
        const double left = residual(gates[n], solution.wind);
        squares += left * left;
        const Vector3 beam = beam_of(gates[n]);
        for (std::size_t i = 0; i < 3; ++i)
            sums[gates[n].sector][i] += beam[i] * left;
    }
    fit.wind.rms_mps = std::sqrt(squares / static_cast<double>(fit.wind.gates));
    Vector3 variances{};
    double groups = 0;
    for (const Vector3& sum : sums) {
        if (sum == Vector3{}) continue;
        ++groups;
        for (std::size_t i = 0; i < 2; ++i) {
            double part = 0;
            for (std::size_t j = 0; j < 3; ++j)
                part += solution.inverse[i][j] * sum[j];
            variances[i] += part * part;
        }
    }
    const double correction = groups > 1 ? groups / (groups - 1) : 1;
    fit.wind.u_error_mps = std::sqrt(variances[0] * correction);
    fit.wind.v_error_mps = std::sqrt(variances[1] * correction);
}

double mean_nyquist_mps(std::span<const VvpGate> gates) {
    double sum = 0;
    for (const VvpGate& gate : gates)
        sum += static_cast<double>(gate.nyquist_mps);
    return sum / static_cast<double>(gates.size());
}

// Returns the reason why a fit is no wind, or none.
std::optional<NoWind> objection(std::span<const VvpGate> gates, std::size_t moving,
                                const VvpFit& fit) {
    std::size_t still_used = 0, moving_used = 0;
    for (std::size_t n = 0; n < gates.size(); ++n) {
        if (fit.was_used[n] == 0) continue;
        ++(is_moving(gates[n]) ? moving_used : still_used);
    }
    if (still_used > moving_used) return NoWind::clutter;
    if (static_cast<double>(moving_used) < least_used_share * static_cast<double>(moving) ||
        fit.wind.rms_mps > most_rms_per_nyquist * mean_nyquist_mps(gates) ||
        fit.wind.rms_mps >
            std::max(greatest_rms_mps, most_rms_per_speed * fit.wind.motion.speed_mps()))
        return NoWind::scattered;
    if (fit.wind.gates < least_gates) return NoWind::too_few_gates;
    if (fit.wind.gap_deg > most_gap_deg) return NoWind::azimuth_gap;
    return std::nullopt;
}

}  // namespace

tl::expected<VvpFit, NoWind> fit_vvp(std::span<const VvpGate> gates) {
    if (gates.empty()) return tl::unexpected(NoWind::no_echo);
    if (gates.size() < least_gates) return tl::unexpected(NoWind::too_few_gates);
    VvpFit fit;
    fit.was_used.assign(gates.size(), 1);
    if (largest_gap_deg(gates, fit.was_used) > most_gap_deg)
        return tl::unexpected(NoWind::azimuth_gap);
    const auto moving = static_cast<std::size_t>(std::ranges::count_if(gates, is_moving));
    if (moving < least_gates) return tl::unexpected(NoWind::clutter);
    std::optional<Solution> solution = solve_by_sizes(gates);
    for (int round = 0; solution && round < most_rounds; ++round) {
        if (!reject(gates, solution->wind, fit.was_used)) break;
        solution = solve(gates, fit.was_used);
    }
    if (!solution) return tl::unexpected(NoWind::azimuth_gap);
    LayerWind& wind = fit.wind;
    wind.gates = static_cast<std::size_t>(std::ranges::count(fit.was_used, 1));
    wind.rejected_gates = gates.size() - wind.gates;
    wind.gap_deg = largest_gap_deg(gates, fit.was_used);
    wind.motion = {solution->wind[0], solution->wind[1]};
    if (solution->has_w) wind.w_mps = solution->wind[2];
    add_errors(gates, *solution, fit);
    if (const auto reason = objection(gates, moving, fit)) return tl::unexpected(*reason);
    return fit;
}

}  // namespace stormcellar::retrieve
