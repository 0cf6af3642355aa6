#include "render/products/column_summary.h"

#include <gtest/gtest.h>

#include "tests/render/synthetic_storm.h"

namespace stormcellar::render {
namespace {

using grid::CellStatus;

ColumnSummary slow_summary(const grid::BrickView& view, int ix, int iy) {
    ColumnSummary column;
    for (int iz = view.spec->nz() - 1; iz >= 0; --iz) {
        const CellStatus status = view.status(ix, iy, iz);
        if (status != CellStatus::not_seen) column.lowest_seen = static_cast<std::uint16_t>(iz);
        if (status == CellStatus::no_echo) column.has_no_echo = true;
        if (status == CellStatus::range_folded) column.has_range_folded = true;
        if (status == CellStatus::ambiguous) column.has_ambiguous = true;
        if (status == CellStatus::value) {
            column.max_code =
                std::max(column.max_code,
                         view.code_at(view.offset_x(ix) + view.offset_y(iy) + view.offset_z(iz)));
        }
    }
    return column;
}

void expect_same_as_slow(const grid::BrickGrid& bricks) {
    const grid::BrickView view = bricks.view();
    const auto columns = summarize_columns(view, 3);
    ASSERT_EQ(columns.size(), view.spec->column_count());
    std::size_t i = 0;
    for (int iy = 0; iy < view.spec->ny; ++iy) {
        for (int ix = 0; ix < view.spec->nx; ++ix, ++i) {
            const ColumnSummary slow = slow_summary(view, ix, iy);
            ASSERT_EQ(columns[i].lowest_seen, slow.lowest_seen) << ix << " " << iy;
            ASSERT_EQ(columns[i].max_code, slow.max_code);
            ASSERT_EQ(columns[i].has_no_echo, slow.has_no_echo);
            ASSERT_EQ(columns[i].has_range_folded, slow.has_range_folded);
            ASSERT_EQ(columns[i].has_ambiguous, slow.has_ambiguous);
        }
    }
}

TEST(ColumnSummary, AgreesWithASlowSearchOverAStorm) {
    const grid::Grid storm = storm_grid(small_spec(150, 37, 2000, 450));
    expect_same_as_slow(bricks_of(storm, 1));
    expect_same_as_slow(bricks_of(storm, 2));
}

// The grid has bricks of one state, bricks of states without codes, and bricks of codes, with every
// mixture of states in a column.
TEST(ColumnSummary, AgreesWithASlowSearchOverEveryMixtureOfStates) {
    for (const bool has_ambiguous : {false, true}) {
        const auto grid = make_grid_of(small_spec(49, 20), [&](int ix, int iy, int iz) -> Cell {
            if (ix < 16) return {CellStatus::no_echo, 0};
            const unsigned hash = static_cast<unsigned>(ix) * 73856093U ^
                                  static_cast<unsigned>(iy) * 19349663U ^
                                  static_cast<unsigned>(iz / 3) * 83492791U;
            const unsigned state = (hash >> 3) % (iy < 16 ? 3 : has_ambiguous ? 5 : 4);
            if (state == 4) return {CellStatus::ambiguous, 0};
            return {static_cast<CellStatus>(state), static_cast<float>(hash % 70)};
        });
        expect_same_as_slow(bricks_of(grid, 1, has_ambiguous));
        expect_same_as_slow(bricks_of(grid, 2, has_ambiguous));
    }
}

// The largest code of a column of ambiguous cells is 3, which is not a value.
TEST(ColumnSummary, OfAmbiguousCellsHasNoMaximum) {
    const auto grid = make_grid_of(small_spec(16, 16), [](int, int, int) {
        return Cell{CellStatus::ambiguous, 0};
    });
    for (const int code_bytes : {1, 2}) {
        const auto bricks = bricks_of(grid, code_bytes, true);
        for (const ColumnSummary& column : summarize_columns(bricks.view(), 1)) {
            ASSERT_EQ(column.max_code, 0);
            ASSERT_EQ(column.status(), CellStatus::ambiguous);
            ASSERT_EQ(column.lowest_seen, 0) << "ambiguous echo was seen";
        }
    }
}

TEST(ColumnSummary, StatusOfTheMaximum) {
    ColumnSummary column;
    EXPECT_EQ(column.status(), CellStatus::not_seen);
    column.has_no_echo = true;
    EXPECT_EQ(column.status(), CellStatus::no_echo);
    column.has_range_folded = true;
    EXPECT_EQ(column.status(), CellStatus::range_folded) << "folded echo may hide any state";
    column.has_ambiguous = true;
    EXPECT_EQ(column.status(), CellStatus::ambiguous);
    column.max_code = 3;
    EXPECT_EQ(column.status(), CellStatus::value);
}

}  // namespace
}  // namespace stormcellar::render
