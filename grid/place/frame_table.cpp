#include "grid/place/frame_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "stormcellar/grid/projection.h"

namespace stormcellar::grid {
namespace {

constexpr std::size_t order = 6;  // number of nodes along each side
constexpr int largest_side = 128;
// A block of at most this many columns is solved exactly, because nodes and checks would cost as
// much.
constexpr int fewest_columns = 128;
constexpr double farthest_m = 15e6;  // closer to the antipode, directions from the site diverge

struct Block {
    int x, y, width, height;  // in columns
};

// node() returns the nodes of Chebyshev, where T6 is 0. peak() returns the peaks of T6. Both are
// places on a side that goes from -1 to 1.
double node(std::size_t i) {
    return std::cos((2.0 * static_cast<double>(i) + 1) * std::numbers::pi / (2 * order));
}
double peak(std::size_t i) {
    return std::cos(static_cast<double>(i) * std::numbers::pi / order);
}

// The values, at one place, of the polynomials that are 1 at one node and 0 at all others.
using Weights = std::array<double, order>;
Weights weights_at(double t) {
    Weights weights;
    weights.fill(1);
    for (std::size_t i = 0; i < order; ++i) {
        for (std::size_t j = 0; j < order; ++j) {
            if (j != i) weights[i] *= (t - node(j)) / (node(i) - node(j));
        }
    }
    return weights;
}

// Returns the weights at the centers of `count` columns. The outer edges of the columns are at -1
// and 1.
std::vector<Weights> weights_of_columns(int count) {
    std::vector<Weights> weights;
    weights.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i)
        weights.push_back(weights_at((2.0 * i + 1) / count - 1));
    return weights;
}

class TableFiller {
  public:
    TableFiller(const GridSpec& spec, const SiteFrame& site, const TakePlaces& take)
        : projection_(spec), site_(site), take_(take) {
        for (std::size_t i = 0; i <= order; ++i)
            peak_weights_[i] = weights_at(peak(i));
    }

    void fill(const Block& block) {
        if (block.width * block.height <= fewest_columns) return solve_each(block);
        if (solve_nodes(block) && holds(block)) return interpolate(block);
        const int left = (block.width + 1) / 2;
        const int low = (block.height + 1) / 2;
        for (const auto& [y, height] : {std::pair{0, low}, std::pair{low, block.height - low}}) {
            for (const auto& [x, width] :
                 {std::pair{0, left}, std::pair{left, block.width - left}}) {
                if (width > 0 && height > 0) fill({block.x + x, block.y + y, width, height});
            }
        }
    }

    [[nodiscard]] std::size_t geodesics() const { return geodesics_; }

  private:
    using Square = std::array<std::array<PlanePoint, order>, order>;

    PlanePoint solve(double x, double y) {
        ++geodesics_;
        return SiteFrame::to_plane(site_.to_polar(projection_.to_geo({x, y})));
    }
    // For s and t, -1 and 1 are the outer edges of the block's columns.
    PlanePoint solve_in(const Block& block, double s, double t) {
        return solve(block.x - 0.5 + 0.5 * block.width * (1 + s),
                     block.y - 0.5 + 0.5 * block.height * (1 + t));
    }

    void solve_each(const Block& block) {
        run_.resize(static_cast<std::size_t>(block.width));
        for (int iy = block.y; iy < block.y + block.height; ++iy) {
            for (int i = 0; i < block.width; ++i)
                run_[static_cast<std::size_t>(i)] = solve(block.x + i, iy);
            take_(iy, block.x, run_);
        }
    }

    // Returns false if a node is so far from the site that the plane is not smooth there.
    bool solve_nodes(const Block& block) {
        for (std::size_t j = 0; j < order; ++j) {
            for (std::size_t i = 0; i < order; ++i) {
                const PlanePoint at = solve_in(block, node(i), node(j));
                if (!(std::hypot(at.x_m, at.y_m) < farthest_m)) return false;
                values_[j][i] = at;
            }
        }
        return true;
    }

    // Returns the values at the nodes along x, at one place along y.
    [[nodiscard]] std::array<PlanePoint, order> row_at(const Weights& weights) const {
        std::array<PlanePoint, order> row{};
        for (std::size_t j = 0; j < order; ++j) {
            for (std::size_t i = 0; i < order; ++i) {
                row[i].x_m += weights[j] * values_[j][i].x_m;
                row[i].y_m += weights[j] * values_[j][i].y_m;
            }
        }
        return row;
    }
    static PlanePoint value_of(const std::array<PlanePoint, order>& row, const Weights& weights) {
        PlanePoint value;
        for (std::size_t i = 0; i < order; ++i) {
            value.x_m += weights[i] * row[i].x_m;
            value.y_m += weights[i] * row[i].y_m;
        }
        return value;
    }

    // At the peaks, the errors along x and along y occur with all combinations of signs. So they
    // cannot cancel at all peaks.
    bool holds(const Block& block) {
        for (std::size_t j = 0; j <= order; ++j) {
            const auto row = row_at(peak_weights_[j]);
            for (std::size_t i = 0; i <= order; ++i) {
                const PlanePoint value = value_of(row, peak_weights_[i]);
                const PlanePoint exact = solve_in(block, peak(i), peak(j));
                const double off_m = std::hypot(value.x_m - exact.x_m, value.y_m - exact.y_m);
                if (!(off_m <= frame_table_error_m / 2)) return false;
            }
        }
        return true;
    }

    void interpolate(const Block& block) {
        const auto across = weights_of_columns(block.width);
        const auto up = weights_of_columns(block.height);
        run_.resize(across.size());
        for (std::size_t j = 0; j < up.size(); ++j) {
            const auto row = row_at(up[j]);
            for (std::size_t i = 0; i < across.size(); ++i)
                run_[i] = value_of(row, across[i]);
            take_(block.y + static_cast<int>(j), block.x, run_);
        }
    }

    GridProjection projection_;
    SiteFrame site_;
    const TakePlaces& take_;
    std::array<Weights, order + 1> peak_weights_{};
    Square values_{};
    std::vector<PlanePoint> run_;
    std::size_t geodesics_ = 0;
};

}  // namespace

std::size_t fill_by_table(const GridSpec& spec, const SiteFrame& site, const TakePlaces& take) {
    TableFiller filler(spec, site, take);
    for (int y = 0; y < spec.ny; y += largest_side) {
        for (int x = 0; x < spec.nx; x += largest_side) {
            filler.fill(
                {x, y, std::min(largest_side, spec.nx - x), std::min(largest_side, spec.ny - y)});
        }
    }
    return filler.geodesics();
}

}  // namespace stormcellar::grid
