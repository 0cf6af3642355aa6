#include "stormcellar/grid/site_distance.h"

#include <algorithm>
#include <cmath>

#include "base/floating_point.h"
#include "stormcellar/grid/projection.h"

namespace stormcellar::grid {
namespace {

constexpr int widest_step = 8;
constexpr double tolerance_m = 0.05;   // a check accepts an arc with at most this error
constexpr double least_arc_m = 100e3;  // shorter arcs may err more
// Patches whose nodes are all farther away than this are not checked, because no caller uses them.
constexpr double farthest_asked_m = 2000e3;
// If there are more, only every fourth along x and y is checked.
constexpr int patches_to_ask = 1024;

// The weights of three nodes, which are at -1, 0 and 1.
using Weights = std::array<double, 3>;
constexpr Weights weights_at(double t) {
    return {0.5 * t * (t - 1), 1 - t * t, 0.5 * t * (t + 1)};
}

// Computes the square of the arc at fractional columns of a domain.
class Solver {
  public:
    Solver(const GridSpec& domain, const GridWindow& window, const SitePosition& site)
        : projection_(domain), frame_(site.latitude_deg, site.longitude_deg), window_(window) {}

    // Returns the square of the arc at a place of the window. Returns NaN beyond a pole of a grid
    // in degrees.
    [[nodiscard]] double at(double x, double y) const {
        const double arc_m =
            frame_.to_polar(projection_.to_geo({window_.first_x + x, window_.first_y + y})).arc_m;
        return arc_m * arc_m;
    }

  private:
    GridProjection projection_;
    SiteFrame frame_;
    GridWindow window_;
};

struct Lattice {
    int step;
    int nodes_x, nodes_y;
    std::vector<double> nodes;

    [[nodiscard]] double value(int patch_x, int patch_y, const Weights& x, const Weights& y) const {
        double sum = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t j = 0; j < 3; ++j)
                sum += x[i] * y[j] *
                       node(2 * patch_x + static_cast<int>(i), 2 * patch_y + static_cast<int>(j));
        }
        return sum;
    }
    [[nodiscard]] double node(int i, int j) const {
        return nodes[static_cast<std::size_t>(i) * static_cast<std::size_t>(nodes_y) +
                     static_cast<std::size_t>(j)];
    }
};

Lattice solve_nodes(const Solver& solver, const GridWindow& window, int step) {
    // Returns the number of nodes along a side of the window: one for each column, or enough to
    // cover whole bricks with nodes at both ends.
    const auto along = [&](int cells) {
        return step == 1 ? cells : bricks_along(cells) * brick_edge / step + 1;
    };
    Lattice lattice{step, along(window.nx), along(window.ny), {}};
    lattice.nodes.reserve(static_cast<std::size_t>(lattice.nodes_x) *
                          static_cast<std::size_t>(lattice.nodes_y));
    for (int i = 0; i < lattice.nodes_x; ++i) {
        for (int j = 0; j < lattice.nodes_y; ++j)
            lattice.nodes.push_back(solver.at(1.0 * i * step, 1.0 * j * step));
    }
    return lattice;
}

[[nodiscard]] bool is_far(const Lattice& lattice, int patch_x, int patch_y) {
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            const double squared_m2 = lattice.node(2 * patch_x + i, 2 * patch_y + j);
            if (!std::isgreater(squared_m2, farthest_asked_m * farthest_asked_m)) return false;
        }
    }
    return true;
}

// Returns true if the lattice is accurate enough. The error of a polynomial of second degree is
// largest at 1 / sqrt(3) between its nodes, so it is checked there.
bool holds(const Lattice& lattice, const Solver& solver) {
    static constexpr double peak = 0.577;
    static constexpr Weights weights = weights_at(peak);
    const int patches_x = (lattice.nodes_x - 1) / 2;
    const int patches_y = (lattice.nodes_y - 1) / 2;
    const int step = patches_x * patches_y > patches_to_ask ? 4 : 1;
    const auto asked = [&](int at, int count) { return at % step == 0 || at + 1 == count; };
    for (int i = 0; i < patches_x; ++i) {
        for (int j = 0; j < patches_y; ++j) {
            if (!asked(i, patches_x) || !asked(j, patches_y) || is_far(lattice, i, j)) continue;
            const double exact_m2 =
                solver.at((2 * i + 1 + peak) * lattice.step, (2 * j + 1 + peak) * lattice.step);
            const double off_m2 = std::abs(lattice.value(i, j, weights, weights) - exact_m2);
            const double most_m2 = 2 * tolerance_m * std::fmax(std::sqrt(exact_m2), least_arc_m);
            if (!std::islessequal(off_m2, most_m2)) return false;
        }
    }
    return true;
}

}  // namespace

SiteDistance::SiteDistance(const GridSpec& domain, const GridWindow& window,
                           const SitePosition& site)
    : window_(window), latitude_deg_(site.latitude_deg), longitude_deg_(site.longitude_deg) {
    const MaskedTraps masked;
    const Solver solver(domain, window, site);
    Lattice lattice;
    for (step_ = widest_step; step_ > 1; step_ /= 2) {
        lattice = solve_nodes(solver, window, step_);
        if (holds(lattice, solver)) break;
    }
    if (step_ == 1) lattice = solve_nodes(solver, window, 1);
    nodes_y_ = lattice.nodes_y;
    nodes_ = std::move(lattice.nodes);
}

bool SiteDistance::is_of(const SitePosition& site) const {
    return site.latitude_deg == latitude_deg_ && site.longitude_deg == longitude_deg_;
}

void SiteDistance::squared_arcs_m2(int bx, int by, ColumnValues& to) const {
    const int first_x = bx * brick_edge - window_.first_x;
    const int first_y = by * brick_edge - window_.first_y;
    const auto node = [&](int i, int j) {
        return nodes_.data() + static_cast<std::size_t>(i) * static_cast<std::size_t>(nodes_y_) + j;
    };
    if (step_ == 1) {
        to.fill(0);
        const int end_x = std::min(brick_edge, window_.nx - first_x);
        const int end_y = std::min(brick_edge, window_.ny - first_y);
        for (int x = 0; x < end_x; ++x) {
            std::transform(node(first_x + x, first_y), node(first_x + x, first_y + end_y),
                           to.begin() + x * brick_edge,
                           [](double squared) { return static_cast<float>(squared); });
        }
        return;
    }
    std::array<Weights, brick_edge> weights{};
    for (int i = 0; i < 2 * step_; ++i)
        weights[static_cast<std::size_t>(i)] = weights_at(1.0 * i / step_ - 1);
    const int patch = 2 * step_;
    for (int x = 0; x < brick_edge; ++x) {
        const Weights& across = weights[static_cast<std::size_t>(x % patch)];
        const int i = (first_x + x / patch * patch) / step_;
        for (int y = 0; y < brick_edge; y += patch) {
            std::array<double, 3> row{};
            const int j = (first_y + y) / step_;
            for (int k = 0; k < 3; ++k) {
                row[static_cast<std::size_t>(k)] = across[0] * *node(i, j + k) +
                                                   across[1] * *node(i + 1, j + k) +
                                                   across[2] * *node(i + 2, j + k);
            }
            float* run = to.data() + x * brick_edge + y;
            for (int k = 0; k < patch; ++k) {
                const Weights& up = weights[static_cast<std::size_t>(k)];
                run[k] = static_cast<float>(
                    std::max(0.0, up[0] * row[0] + up[1] * row[1] + up[2] * row[2]));
            }
        }
    }
}

}  // namespace stormcellar::grid
