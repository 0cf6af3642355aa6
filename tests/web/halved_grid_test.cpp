// Compares halved grids with the rule, cell by cell.
#include "web/data/grids/halved_grid.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include <gtest/gtest.h>

namespace stormcellar::web {
namespace {

using grid::CellStatus;

// Returns a grid of odd sizes with patches of every state, so that it has bricks of each kind. With
// `has_ambiguous`, some bricks have only ambiguous cells.
grid::Grid patched_grid(bool has_ambiguous = false) {
    grid::Grid made;
    made.spec.nx = 53;
    made.spec.ny = 37;
    for (int level = 1; level <= 19; ++level)
        made.spec.levels_m.push_back(500.0 * level);
    made.values.assign(made.spec.cell_count(), 0.0F);
    made.status.assign(made.spec.cell_count(), CellStatus::not_seen);
    std::mt19937 numbers(7);
    for (int ix = 0; ix < made.spec.nx; ++ix) {
        for (int iy = 0; iy < made.spec.ny; ++iy) {
            for (int iz = 0; iz < made.spec.nz(); ++iz) {
                const std::size_t at = made.spec.index(ix, iy, iz);
                const int patch = (ix / 16 + iy / 16) % 4;
                const auto mixed = static_cast<CellStatus>(numbers() % 4);
                made.status[at] = patch == 0   ? CellStatus::no_echo
                                  : patch == 1 ? static_cast<CellStatus>(numbers() % 3)
                                               : mixed;
                if (has_ambiguous && (patch == 0 ? iy < 20 : numbers() % 4 == 0))
                    made.status[at] = CellStatus::ambiguous;
                if (made.status[at] == CellStatus::value)
                    made.values[at] = 0.5F * static_cast<float>(numbers() % 120) - 30;
            }
        }
    }
    return made;
}

struct Cell {
    CellStatus status = CellStatus::not_seen;
    float value = 0;
};

// Returns the maximum of the four cells that a halved cell covers, by the rule in the header.
Cell greatest_of(const grid::BrickView& view, int x, int y, int z, bool by_magnitude) {
    Cell made;
    bool has_no_echo = false, has_folded = false, has_ambiguous = false;
    for (int ix = 2 * x; ix < std::min(2 * x + 2, view.spec->nx); ++ix) {
        for (int iy = 2 * y; iy < std::min(2 * y + 2, view.spec->ny); ++iy) {
            const CellStatus status = view.status(ix, iy, z);
            has_no_echo |= status == CellStatus::no_echo;
            has_folded |= status == CellStatus::range_folded;
            has_ambiguous |= status == CellStatus::ambiguous;
            if (status != CellStatus::value) continue;
            const float value = view.value(ix, iy, z);
            const bool is_greater =
                by_magnitude ? std::abs(value) > std::abs(made.value) : value > made.value;
            if (made.status != CellStatus::value || is_greater) made = {CellStatus::value, value};
        }
    }
    if (made.status == CellStatus::value) return made;
    if (has_ambiguous) return {CellStatus::ambiguous, 0};
    if (has_folded) return {CellStatus::range_folded, 0};
    return {has_no_echo ? CellStatus::no_echo : CellStatus::not_seen, 0};
}

void expect_maxima(level2::Moment moment, bool by_magnitude) {
    const grid::BrickGrid whole = grid::BrickGrid::from(
        patched_grid(level2::facts_of(moment).is_derived), grid::default_quantization(moment));
    const auto half = halved(whole.view(), moment, 1, HalvedBy::maximum);
    ASSERT_TRUE(half) << half.error().message;
    const grid::BrickView view = (*half)->view();
    ASSERT_EQ(view.spec->nx, 27);
    ASSERT_EQ(view.spec->ny, 19);
    int values = 0;
    for (int x = 0; x < 27; ++x) {
        for (int y = 0; y < 19; ++y) {
            for (int z = 0; z < 19; ++z) {
                const Cell expected = greatest_of(whole.view(), x, y, z, by_magnitude);
                ASSERT_EQ(view.status(x, y, z), expected.status) << x << ' ' << y << ' ' << z;
                if (expected.status != CellStatus::value) continue;
                const float found = view.value(x, y, z);
                ASSERT_EQ(by_magnitude ? std::abs(found) : found,
                          by_magnitude ? std::abs(expected.value) : expected.value);
                ++values;
            }
        }
    }
    EXPECT_GT(values, 1000);
}

TEST(HalvedGrid, TheMaximumIsThatOfFourCells) {
    expect_maxima(level2::Moment::ref, false);
}

TEST(HalvedGrid, OfCodesOfTwoBytesToo) {
    expect_maxima(level2::Moment::zdr, false);
}

TEST(HalvedGrid, OfVelocitiesItIsTheFastest) {
    expect_maxima(level2::Moment::vel, true);
    expect_maxima(level2::Moment::veld, true);
}

// Code 3 is ambiguous and must not enter a mean. The status is by the rule of all mixtures
// (docs/geometry.md), but among states with equal counts, range folding comes before ambiguous.
TEST(HalvedGrid, TheMeanHasNoAmbiguousCellInIt) {
    const grid::BrickGrid whole =
        grid::BrickGrid::from(patched_grid(true), grid::default_quantization(level2::Moment::veld));
    const grid::BrickView view = whole.view();
    const auto half = halved(view, level2::Moment::veld, 1, HalvedBy::mean);
    ASSERT_TRUE(half) << half.error().message;
    int values = 0, ambiguous = 0;
    for (int x = 0; x < 26; ++x) {
        for (int y = 0; y < 18; ++y) {
            for (int z = 0; z < 19; ++z) {
                std::map<CellStatus, int> counts;
                double sum = 0;
                for (const auto& [ix, iy] : {std::pair{2 * x, 2 * y},
                                             {2 * x + 1, 2 * y},
                                             {2 * x, 2 * y + 1},
                                             {2 * x + 1, 2 * y + 1}}) {
                    const CellStatus status = view.status(ix, iy, z);
                    ++counts[status];
                    if (status == CellStatus::value)
                        sum += static_cast<double>(view.value(ix, iy, z));
                }
                const CellStatus found = (*half)->view().status(x, y, z);
                const int valued = counts[CellStatus::value];
                const int unknown =
                    counts[CellStatus::range_folded] + counts[CellStatus::ambiguous];
                if (found == CellStatus::value) {
                    ASSERT_GE(valued, std::max(unknown, counts[CellStatus::no_echo]));
                    ASSERT_NEAR((*half)->view().value(x, y, z), sum / valued, 0.125);
                    ++values;
                }
                if (found == CellStatus::ambiguous) {
                    ASSERT_GT(counts[CellStatus::ambiguous], counts[CellStatus::range_folded]);
                    ASSERT_GT(unknown, valued);
                    ++ambiguous;
                }
                if (counts[CellStatus::ambiguous] == 4) {
                    ASSERT_EQ(found, CellStatus::ambiguous);
                }
            }
        }
    }
    EXPECT_GT(values, 300);
    EXPECT_GT(ambiguous, 300);
}

TEST(HalvedGrid, HalvedTwiceIsTheMaximumOfSixteen) {
    const grid::BrickGrid whole =
        grid::BrickGrid::from(patched_grid(), grid::default_quantization(level2::Moment::ref));
    const auto once = halved(whole.view(), level2::Moment::ref, 1, HalvedBy::maximum);
    const auto twice = halved(whole.view(), level2::Moment::ref, 2, HalvedBy::maximum);
    ASSERT_TRUE(once && twice);
    for (int x = 0; x < 14; ++x) {
        for (int y = 0; y < 10; ++y) {
            for (int z = 0; z < 19; ++z) {
                const Cell expected = greatest_of((*once)->view(), x, y, z, false);
                ASSERT_EQ((*twice)->view().status(x, y, z), expected.status);
                if (expected.status == CellStatus::value) {
                    ASSERT_EQ((*twice)->view().value(x, y, z), expected.value);
                }
            }
        }
    }
}

}  // namespace
}  // namespace stormcellar::web
