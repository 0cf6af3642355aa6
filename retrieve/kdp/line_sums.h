// retrieve/kdp/line_sums.h -- sums of the good gates of a radial, for lines by least squares.
//
// Units     Degrees and gates.
// Threads   Plain data and pure functions.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "retrieve/kdp/phase_row.h"

namespace stormcellar::retrieve {

// Sums for a line by least squares.
struct LineSums {
    double n = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;

    LineSums operator+(const LineSums& other) const {
        return {n + other.n, x + other.x, y + other.y, xx + other.xx, xy + other.xy, yy + other.yy};
    }
};

struct Line {
    double slope = 0, x = 0, y = 0;  // through (x, y), the mean of its points
    double spread = 0;               // sum of squared distances from x
    double n = 0;
};

inline std::optional<Line> line_of(const LineSums& sums) {
    if (sums.n < 3) return std::nullopt;
    const double spread = sums.xx - sums.x * sums.x / sums.n;
    if (!(spread > 0)) return std::nullopt;
    const double slope = (sums.xy - sums.x * sums.y / sums.n) / spread;
    return Line{slope, sums.x / sums.n, sums.y / sums.n, spread, sums.n};
}

// Returns the root mean square of the residuals, corrected for the two parameters of the line.
inline double residual_deg(const LineSums& sums, const Line& line) {
    const double squares =
        sums.yy - sums.y * sums.y / sums.n - line.slope * line.slope * line.spread;
    return std::sqrt(std::max(0.0, squares) / (sums.n - 2));
}

// Gives the sums of any range of gates that begins at most `reach` gates before the row, and ends
// at most `reach` gates behind it.
class RowSums {
  public:
    enum Term : std::size_t { n, x, y, xx, xy, yy, terms };

    // Vectors may read this many numbers beyond the reach, but do not use them.
    static constexpr std::ptrdiff_t spare = 16;

    // Takes another row, and uses the memory of the last row again.
    void read(const PhaseRow& row, std::ptrdiff_t reach) {
        reach_ = reach;
        const std::size_t gates = row.phases_deg.size();
        for (std::vector<double>& term : before_)
            term.assign(gates + 1 + static_cast<std::size_t>(2 * reach + spare), 0);
        LineSums sums;
        auto at = static_cast<std::size_t>(reach);
        keep(at, sums);
        for (std::size_t gate = 0; gate < gates; ++gate) {
            if (row.is_good[gate] != 0) {
                const double place = static_cast<double>(gate), phase = row.phases_deg[gate];
                sums =
                    sums + LineSums{1, place, phase, place * place, place * phase, phase * phase};
            }
            keep(++at, sums);
        }
        while (++at < before_[n].size())
            keep(at, sums);
    }

    // Sums gates begin to end - 1.
    [[nodiscard]] LineSums between(std::ptrdiff_t begin, std::ptrdiff_t end) const {
        const auto sum = [&](Term term) { return before(term, end)[0] - before(term, begin)[0]; };
        return {sum(n), sum(x), sum(y), sum(xx), sum(xy), sum(yy)};
    }
    [[nodiscard]] double count(std::ptrdiff_t begin, std::ptrdiff_t end) const {
        return before(n, end)[0] - before(n, begin)[0];
    }
    // Returns a pointer to the sum of a term over the gates before this one. The sums for the next
    // gates follow.
    [[nodiscard]] const double* before(Term term, std::ptrdiff_t gate) const {
        return before_[term].data() + (gate + reach_);
    }

  private:
    void keep(std::size_t at, const LineSums& sums) {
        before_[n][at] = sums.n;
        before_[x][at] = sums.x;
        before_[y][at] = sums.y;
        before_[xx][at] = sums.xx;
        before_[xy][at] = sums.xy;
        before_[yy][at] = sums.yy;
    }

    std::array<std::vector<double>, terms> before_;
    std::ptrdiff_t reach_ = 0;
};

}  // namespace stormcellar::retrieve
