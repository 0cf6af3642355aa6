// tests/grid/made_partials.h -- partials (each is one site's grid on its part of a domain) of
// synthetic sites, for tests of merging.
#pragma once

#include <algorithm>
#include <array>
#include <cstring>
#include <deque>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "stormcellar/grid/mosaic.h"

namespace stormcellar::grid {

inline constexpr Quantization one_byte{1, -32, 0.5F};
inline constexpr Quantization two_bytes{2, -40, 0.01F};

// Returns a domain of 70 x 52 columns of some 12 km and 18 levels, whose last bricks are cut along
// every axis.
inline GridSpec small_domain() {
    GridSpec spec = default_spec(41, -75);
    spec.projection = Projection::latitude_longitude;
    spec.spacing_m = 0;
    spec.spacing_deg = 0.12;
    spec.nx = 70;
    spec.ny = 52;
    spec.levels_m.clear();
    for (int level = 1; level <= 18; ++level)
        spec.levels_m.push_back(350.0 * level);
    return spec;
}

// Holds grids, and partials that point to them.
class Partials {
  public:
    explicit Partials(GridSpec domain) : domain_(std::move(domain)) {}

    template <class Fill>
    void add(const SitePosition& site, const GridWindow& window, const Quantization& quantization,
             Fill fill) {
        Grid grid;
        grid.spec = window_spec(domain_, window);
        grid.values.assign(grid.spec.cell_count(), 0);
        grid.status.assign(grid.spec.cell_count(), CellStatus::not_seen);
        for (int iy = 0; iy < window.ny; ++iy) {
            for (int ix = 0; ix < window.nx; ++ix) {
                for (int iz = 0; iz < domain_.nz(); ++iz) {
                    const std::size_t cell = grid.spec.index(ix, iy, iz);
                    fill(window.first_x + ix, window.first_y + iy, iz, grid.status[cell],
                         grid.values[cell]);
                }
            }
        }
        grids_.push_back(BrickGrid::from(grid, quantization));
        all_.push_back({grids_.back().view(), site});
    }
    // Adds a partial with bricks of every kind: some uniform, some with states only, some with
    // values.
    void add_random(const SitePosition& site, const GridWindow& window,
                    const Quantization& quantization, unsigned seed) {
        std::mt19937 random(seed);
        std::vector<int> kinds;
        for (int i = 0; i < 1000; ++i)
            kinds.push_back(static_cast<int>(random() % 6));
        add(site, window, quantization, [&](int ix, int iy, int iz, auto& status, float& value) {
            const int brick = (ix / 16 * 7 + iy / 16) * 3 + iz / 16;
            const int kind = kinds[static_cast<std::size_t>(brick)];
            const auto drawn = static_cast<unsigned>(random() % 8);
            if (kind < 3) {
                status = static_cast<CellStatus>(kind == 2 && drawn == 0 ? 0 : kind % 2);
            } else if (kind == 3) {
                status = static_cast<CellStatus>(drawn % 3);
            } else {
                status = drawn < 4 ? CellStatus::value : static_cast<CellStatus>(drawn % 3);
            }
            if (status == CellStatus::value) {
                value = static_cast<float>(-10 + 0.01 * static_cast<double>(random() % 7000));
            }
        });
    }
    [[nodiscard]] const GridSpec& domain() const { return domain_; }
    std::vector<Partial>& all() { return all_; }

  private:
    GridSpec domain_;
    std::deque<BrickGrid> grids_;
    std::vector<Partial> all_;
};

inline const std::array<SitePosition, 5> sites = {{{"KBGM", 42.2, -75.98, 519},
                                                   {"KENX", 42.59, -74.06, 557},
                                                   {"KDIX", 39.95, -74.41, 45},
                                                   {"KCCX", 40.92, -78.0, 733},
                                                   {"TPHL", 39.95, -75.07, 46}}};
inline const std::array<GridWindow, 5> windows = {
    {{0, 0, 64, 52}, {16, 16, 54, 32}, {32, 0, 38, 48}, {0, 16, 48, 36}, {32, 16, 32, 32}}};

inline Partials random_partials(const Quantization& quantization, unsigned seed = 1) {
    Partials partials(small_domain());
    for (std::size_t i = 0; i < sites.size(); ++i) {
        partials.add_random(sites[i], windows[i], quantization,
                            seed * 100 + static_cast<unsigned>(i));
    }
    return partials;
}

inline void expect_same_bits(const BrickView& a, const BrickView& b) {
    ASSERT_EQ(*a.spec, *b.spec);
    ASSERT_EQ(a.quantization, b.quantization);
    ASSERT_EQ(a.bricks.size(), b.bricks.size());
    EXPECT_EQ(std::memcmp(a.bricks.data(), b.bricks.data(), a.bricks.size_bytes()), 0);
    ASSERT_EQ(a.states.size(), b.states.size());
    EXPECT_TRUE(std::equal(a.states.begin(), a.states.end(), b.states.begin()));
    ASSERT_EQ(a.codes.size(), b.codes.size());
    EXPECT_EQ(std::memcmp(a.codes.data(), b.codes.data(), a.codes.size()), 0);
}

inline void expect_same_bits(const Mosaic& a, const Mosaic& b) {
    expect_same_bits(a.cells.view(), b.cells.view());
    ASSERT_EQ(a.counts.has_value(), b.counts.has_value());
    if (a.counts) expect_same_bits(a.counts->view(), b.counts->view());
    ASSERT_EQ(a.weights.has_value(), b.weights.has_value());
    if (a.weights) expect_same_bits(a.weights->view(), b.weights->view());
}

}  // namespace stormcellar::grid
