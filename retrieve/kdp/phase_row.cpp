#include "retrieve/kdp/phase_row.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace stormcellar::retrieve {
namespace {

constexpr float least_correlation = 0.85F;
constexpr std::ptrdiff_t reach_of_agreement = 4;
constexpr float agreement_deg = 30;
constexpr int least_neighbors = 4;
constexpr double agreeing_share = 0.7;
constexpr std::size_t most_remembered = 5;
constexpr double least_noise_deg = 0.1, unknown_noise_deg = 5;

bool is_candidate(std::span<const float> phases, std::span<const float> correlations,
                  std::size_t gate) {
    if (!std::isfinite(phases[gate])) return false;
    return correlations.empty() || std::isgreaterequal(correlations[gate], least_correlation);
}

// Returns how far apart two phases are on the circle.
float apart_deg(float a, float b) {
    const float between = std::abs(a - b);
    if (between <= 180) return between;
    // std::remainder() gives the same bits, but is slower.
    if (between < 540) return std::abs(between - 360);
    return std::abs(std::remainder(between, 360.0F));
}

// Returns true if most candidates near a gate agree with its phase.
bool agrees(std::span<const float> phases, const std::vector<std::uint8_t>& candidates,
            std::ptrdiff_t gate) {
    const auto gates = static_cast<std::ptrdiff_t>(phases.size());
    int neighbors = 0, agreeing = 0;
    for (std::ptrdiff_t at = std::max<std::ptrdiff_t>(0, gate - reach_of_agreement);
         at <= std::min(gates - 1, gate + reach_of_agreement); ++at) {
        if (at == gate || candidates[static_cast<std::size_t>(at)] == 0) continue;
        ++neighbors;
        const float apart =
            apart_deg(phases[static_cast<std::size_t>(at)], phases[static_cast<std::size_t>(gate)]);
        agreeing += apart <= agreement_deg ? 1 : 0;
    }
    return neighbors >= least_neighbors && agreeing >= agreeing_share * neighbors;
}

// Remembers the last unfolded phases, whose mean tells the turn of the next phase.
class PhaseMemory {
  public:
    [[nodiscard]] double unfolded(double phase) const {
        if (count_ == 0) return phase;
        const double mean = std::accumulate(last_.begin(), last_.begin() + used(), 0.0) /
                            static_cast<double>(used());
        const double apart = phase - mean;
        return mean + (std::abs(apart) <= 180 ? apart : std::remainder(apart, 360));
    }
    void keep(double phase) { last_[count_++ % most_remembered] = phase; }

  private:
    [[nodiscard]] std::ptrdiff_t used() const {
        return static_cast<std::ptrdiff_t>(std::min(count_, most_remembered));
    }
    std::array<double, most_remembered> last_{};
    std::size_t count_ = 0;
};

}  // namespace

PhaseRow unfold_phases(std::span<const float> phases_deg, std::span<const float> correlations) {
    const std::size_t gates = phases_deg.size();
    PhaseRow row{std::vector<double>(gates, 0), std::vector<std::uint8_t>(gates, 0),
                 std::vector<std::uint8_t>(gates, 0)};
    std::vector<std::uint8_t> candidates(gates);
    for (std::size_t gate = 0; gate < gates; ++gate) {
        row.has_phase[gate] = std::isfinite(phases_deg[gate]) ? 1 : 0;
        candidates[gate] = is_candidate(phases_deg, correlations, gate) ? 1 : 0;
    }
    PhaseMemory memory;
    for (std::size_t gate = 0; gate < gates; ++gate) {
        if (candidates[gate] == 0 ||
            !agrees(phases_deg, candidates, static_cast<std::ptrdiff_t>(gate)))
            continue;
        row.is_good[gate] = 1;
        row.phases_deg[gate] = memory.unfolded(static_cast<double>(phases_deg[gate]));
        memory.keep(row.phases_deg[gate]);
    }
    return row;
}

std::vector<double> phase_noise_deg(const PhaseRow& row, int reach) {
    const std::size_t gates = row.phases_deg.size();
    // The variance of a second difference is six times that of a phase.
    std::vector<double> sums(gates + 1, 0), counts(gates + 1, 0);
    for (std::size_t gate = 0; gate < gates; ++gate) {
        const bool is_whole = gate > 0 && gate + 1 < gates && row.is_good[gate - 1] != 0 &&
                              row.is_good[gate] != 0 && row.is_good[gate + 1] != 0;
        const double second = is_whole ? row.phases_deg[gate - 1] - 2 * row.phases_deg[gate] +
                                             row.phases_deg[gate + 1]
                                       : 0;
        sums[gate + 1] = sums[gate] + second * second / 6;
        counts[gate + 1] = counts[gate] + (is_whole ? 1 : 0);
    }
    std::vector<double> noise(gates);
    const auto far = static_cast<std::size_t>(std::max(reach, 1));
    for (std::size_t gate = 0; gate < gates; ++gate) {
        const std::size_t begin = gate > far ? gate - far : 0;
        const std::size_t end = std::min(gates, gate + far + 1);
        const double count = counts[end] - counts[begin];
        const double deg =
            count >= 4 ? std::sqrt((sums[end] - sums[begin]) / count) : unknown_noise_deg;
        noise[gate] = std::max(deg, least_noise_deg);
    }
    return noise;
}

}  // namespace stormcellar::retrieve
