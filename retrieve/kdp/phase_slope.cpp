#include "retrieve/kdp/phase_slope.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

namespace stormcellar::retrieve {
namespace {

constexpr std::array window_lengths_m = {1750.0, 2250.0,  3250.0,  4750.0,
                                         7250.0, 10250.0, 14250.0, 20250.0};
constexpr float confidence = 2.3F;  // standard errors of the intervals that must intersect
// A gate takes windows with 0, 1, ... or 8 eighths of themselves before it. Windows about it count
// in full, because a slope that changes evenly does not bias them.
constexpr int window_parts = 8;
constexpr float weight_aside = 0.1F;
constexpr double least_good_share = 0.6;
constexpr double least_good_gates = 5;
constexpr double noise_reach_m = 3000;

constexpr std::array backscatter_lengths_m = {1250.0, 2250.0, 3250.0};
constexpr double flank_m = 2500;
constexpr double least_backscatter_deg = 2;
constexpr double backscatter_significance = 5;  // standard errors
constexpr double most_flank_noise = 1.5;        // residuals in noise
constexpr float no_slope = std::numeric_limits<float>::quiet_NaN();

// Sums for a line by least squares.
struct LineSums {
    double n = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;

    LineSums operator+(const LineSums& other) const {
        return {n + other.n, x + other.x, y + other.y, xx + other.xx, xy + other.xy, yy + other.yy};
    }
    LineSums operator-(const LineSums& other) const {
        return {n - other.n, x - other.x, y - other.y, xx - other.xx, xy - other.xy, yy - other.yy};
    }
};

struct Line {
    double slope = 0, x = 0, y = 0;  // through (x, y), the mean of its points
    double spread = 0;               // sum of squared distances from x
    double residual_deg = 0;         // root mean square, two parameters allowed for
    double n = 0;
};

std::optional<Line> line_of(const LineSums& sums) {
    if (sums.n < 3) return std::nullopt;
    const double spread = sums.xx - sums.x * sums.x / sums.n;
    if (!(spread > 0)) return std::nullopt;
    const double slope = (sums.xy - sums.x * sums.y / sums.n) / spread;
    const double squares = sums.yy - sums.y * sums.y / sums.n - slope * slope * spread;
    return Line{slope,
                sums.x / sums.n,
                sums.y / sums.n,
                spread,
                std::sqrt(std::max(0.0, squares) / (sums.n - 2)),
                sums.n};
}

int gates_in(double length_m, double spacing_m) {
    return static_cast<int>(std::clamp(std::lround(length_m / spacing_m), 1L, 400L));
}

// Gives the sums of any range of gates.
class RowSums {
  public:
    explicit RowSums(const PhaseRow& row) : before_(row.phases_deg.size() + 1) {
        for (std::size_t gate = 0; gate < row.phases_deg.size(); ++gate) {
            const double x = static_cast<double>(gate), y = row.phases_deg[gate];
            before_[gate + 1] = before_[gate];
            if (row.is_good[gate] != 0)
                before_[gate + 1] = before_[gate] + LineSums{1, x, y, x * x, x * y, y * y};
        }
    }
    // Sums gates begin to end - 1, both of which may be outside the row.
    [[nodiscard]] LineSums between(std::ptrdiff_t begin, std::ptrdiff_t end) const {
        return before(end) - before(begin);
    }
    [[nodiscard]] double count(std::ptrdiff_t begin, std::ptrdiff_t end) const {
        return before(end).n - before(begin).n;
    }

  private:
    [[nodiscard]] const LineSums& before(std::ptrdiff_t gate) const {
        const auto last = static_cast<std::ptrdiff_t>(before_.size()) - 1;
        return before_[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(gate, 0, last))];
    }
    std::vector<LineSums> before_;
};

// The slope in one window.
struct WindowSlope {
    float slope = 0;
    float error = 0;      // standard error from the noise about the window's middle; 0: no slope
    float fit_error = 0;  // from the residuals if they exceed the noise
};

// The slopes in all windows of one length.
struct WindowSlopes {
    int gates = 0;
    std::vector<WindowSlope> windows;  // by the first gate of the window, from 1 - gates on

    [[nodiscard]] const WindowSlope& from(std::ptrdiff_t begin) const {
        return windows[static_cast<std::size_t>(begin + gates - 1)];
    }
};

WindowSlope slope_in(const RowSums& sums, std::ptrdiff_t begin, int gates, double noise_deg) {
    const double least = std::max(least_good_gates, least_good_share * gates);
    if (sums.count(begin, begin + gates) < least) return {};
    const auto line = line_of(sums.between(begin, begin + gates));
    if (!line) return {};
    const double scale = 1 / std::sqrt(line->spread);
    return {static_cast<float>(line->slope), static_cast<float>(noise_deg * scale),
            static_cast<float>(std::max(noise_deg, line->residual_deg) * scale)};
}

WindowSlopes slopes_of_length(const RowSums& sums, const std::vector<double>& noise, int gates) {
    WindowSlopes slopes{gates, {}};
    const auto last = static_cast<std::ptrdiff_t>(noise.size()) - 1;
    slopes.windows.reserve(noise.size() + static_cast<std::size_t>(gates) - 1);
    for (std::ptrdiff_t begin = 1 - gates; begin <= last; ++begin) {
        const auto middle =
            static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(begin + gates / 2, 0, last));
        slopes.windows.push_back(slope_in(sums, begin, gates, noise[middle]));
    }
    return slopes;
}

// Averages the slopes of windows that hold a gate, weighted by the inverse of their errors.
class SlopeMean {
  public:
    // Adds the windows with `part` eighths of themselves before the gate, from the shortest on, as
    // long as their slopes agree.
    void add(const std::vector<WindowSlopes>& lengths, std::ptrdiff_t gate, int part) {
        const float share = 2 * part == window_parts ? 1 : weight_aside;
        float low = -std::numeric_limits<float>::infinity();
        float high = std::numeric_limits<float>::infinity();
        for (const WindowSlopes& length : lengths) {
            const WindowSlope& window =
                length.from(gate - part * (length.gates - 1) / window_parts);
            if (!(window.error > 0)) continue;
            low = std::max(low, window.slope - confidence * window.error);
            high = std::min(high, window.slope + confidence * window.error);
            if (low > high) return;
            // Residuals above the noise mean that the phase is no ramp here.
            const float weight = share * window.error / (window.fit_error * window.fit_error);
            weights_ += weight;
            slopes_ += weight * window.slope;
            errors_ += weight * window.fit_error;
        }
    }
    [[nodiscard]] bool is_empty() const { return !(weights_ > 0); }
    [[nodiscard]] float slope() const { return slopes_ / weights_; }
    // Returns the mean of the windows' errors, because the windows share their gates.
    [[nodiscard]] float error() const { return errors_ / weights_; }

  private:
    float weights_ = 0, slopes_ = 0, errors_ = 0;
};

bool is_backscatter(const RowSums& sums, std::ptrdiff_t begin, int gates, int flank,
                    double noise_deg) {
    const std::ptrdiff_t end = begin + gates;
    if (sums.count(begin, end) < least_good_share * gates ||
        sums.count(begin - flank, begin) < least_good_share * flank ||
        sums.count(end, end + flank) < least_good_share * flank)
        return false;
    const LineSums inside = sums.between(begin, end);
    const LineSums left = sums.between(begin - flank, begin);
    const LineSums right = sums.between(end, end + flank);
    const auto line = line_of(left + right), before = line_of(left), after = line_of(right);
    if (!line || !before || !after || line->residual_deg > most_flank_noise * noise_deg)
        return false;
    const double x = inside.x / inside.n;
    const double deviation = std::abs(inside.y / inside.n - line->y - line->slope * (x - line->x));
    const double variance =
        1 / inside.n + 1 / line->n + (x - line->x) * (x - line->x) / line->spread;
    // A bend of the phase also leaves the line; the slopes of the flanks tell how far it may.
    const double bend = std::abs(after->slope - before->slope) +
                        2 * noise_deg * std::sqrt(1 / before->spread + 1 / after->spread);
    const double most_of_bend = bend * (after->x - before->x) / 8;
    return deviation >= std::max({least_backscatter_deg, 2 * most_of_bend,
                                  backscatter_significance * noise_deg * std::sqrt(variance)});
}

}  // namespace

void leave_out_backscatter(PhaseRow& row, double spacing_m) {
    const RowSums sums(row);
    const auto noise = phase_noise_deg(row, gates_in(noise_reach_m, spacing_m));
    const int flank = gates_in(flank_m, spacing_m);
    std::vector<std::uint8_t> is_good = row.is_good;
    const auto gates_in_row = static_cast<std::ptrdiff_t>(row.is_good.size());
    for (const double length_m : backscatter_lengths_m) {
        const int gates = gates_in(length_m, spacing_m);
        for (std::ptrdiff_t begin = flank; begin + gates + flank <= gates_in_row; ++begin) {
            const auto middle = static_cast<std::size_t>(begin + gates / 2);
            if (row.is_good[middle] == 0 ||
                !is_backscatter(sums, begin, gates, flank, noise[middle]))
                continue;
            std::fill_n(is_good.begin() + begin, gates, std::uint8_t{0});
        }
    }
    row.is_good = std::move(is_good);
}

PhaseSlopes fit_slopes(const PhaseRow& row, double spacing_m) {
    const std::size_t gates = row.phases_deg.size();
    PhaseSlopes slopes{std::vector<float>(gates, no_slope), std::vector<float>(gates, no_slope)};
    const RowSums sums(row);
    const auto noise = phase_noise_deg(row, gates_in(noise_reach_m, spacing_m));
    std::vector<WindowSlopes> lengths;
    for (const double length_m : window_lengths_m)
        lengths.push_back(slopes_of_length(sums, noise, gates_in(length_m, spacing_m)));
    for (std::size_t gate = 0; gate < gates; ++gate) {
        if (row.has_phase[gate] == 0) continue;
        SlopeMean mean;
        for (int part = 0; part <= window_parts; ++part)
            mean.add(lengths, static_cast<std::ptrdiff_t>(gate), part);
        if (mean.is_empty()) continue;
        slopes.deg_per_gate[gate] = mean.slope();
        slopes.error[gate] = mean.error();
    }
    return slopes;
}

}  // namespace stormcellar::retrieve
