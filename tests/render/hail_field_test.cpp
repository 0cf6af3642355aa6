#include "render/products/hail_field.h"

#include <limits>

#include <gtest/gtest.h>

#include "render/frame/hail_text.h"
#include "tests/render/synthetic_storm.h"

namespace stormcellar::render {
namespace {

using grid::CellStatus;
using retrieve::FreezingLevels;
using retrieve::Hail;

constexpr Cell hail_unseen = {CellStatus::not_seen, 0};
constexpr Cell hail_folded = {CellStatus::range_folded, 0};
constexpr FreezingLevels low_levels{2000, 5000};

Result<FlatField> map_of(const grid::BrickView& view, float Hail::*number, int threads = 1,
                         const FreezingLevels& levels = low_levels) {
    return hail_field(view, number, levels, 384, summarize_columns(view, threads), threads);
}

// The cells of a column as retrieve/hail.h takes them.
std::vector<float> dbz_of(const grid::BrickView& view, int ix, int iy) {
    ColumnCells cells;
    read_column(view, ix, iy, cells);
    for (std::size_t i = 0; i < cells.values.size(); ++i)
        if (cells.status[i] != CellStatus::value)
            cells.values[i] = std::numeric_limits<float>::quiet_NaN();
    return cells.values;
}

// Returns a row of columns, with levels at 500, 1000 ... 10000 m. All cells that a column does not
// list have no echo.
grid::BrickGrid hail_columns(const std::vector<std::vector<Cell>>& columns) {
    grid::GridSpec spec = small_spec(static_cast<int>(columns.size()), 20);
    spec.ny = 1;
    return bricks_of(make_grid_of(spec, [&](int ix, int, int iz) {
        const auto& cells = columns[static_cast<std::size_t>(ix)];
        return static_cast<std::size_t>(iz) < cells.size() ? cells[static_cast<std::size_t>(iz)]
                                                           : Cell{};
    }));
}

TEST(HailField, AgreesWithTheHailOfEachColumn) {
    const grid::Grid storm = storm_grid(small_spec(75, 37, 4000, 400));
    for (const int bytes : {1, 2}) {
        const auto bricks = bricks_of(storm, bytes);
        const grid::BrickView view = bricks.view();
        const auto layers = retrieve::hail_layers(view.spec->levels_m, low_levels, 384).value();
        const auto columns = summarize_columns(view, 1);
        const auto mesh = map_of(view, &Hail::mesh_mm), posh = map_of(view, &Hail::posh_percent),
                   shi = map_of(view, &Hail::shi_j_per_m_s);
        int with_hail = 0;
        for (int iy = 0; iy < 75; ++iy) {
            for (int ix = 0; ix < 75; ++ix) {
                const auto slow = retrieve::hail_of_column(layers, dbz_of(view, ix, iy));
                const std::size_t at = mesh->index(ix, iy);
                ASSERT_EQ(mesh->status[at] == CellStatus::value, slow.shi_j_per_m_s > 0);
                ASSERT_NEAR(mesh->values[at], slow.mesh_mm, 1e-4);
                ASSERT_NEAR(posh->values[at], slow.posh_percent, 1e-4);
                ASSERT_NEAR(shi->values[at], slow.shi_j_per_m_s, 1e-5 * slow.shi_j_per_m_s);
                with_hail += slow.shi_j_per_m_s > 0 ? 1 : 0;
                if (columns[at].lowest_seen == ColumnSummary::never) {
                    ASSERT_EQ(mesh->status[at], CellStatus::not_seen);
                }
            }
        }
        EXPECT_GT(with_hail, 30);
        EXPECT_EQ(map_of(view, &Hail::mesh_mm, 3)->values, mesh->values);
        EXPECT_EQ(map_of(view, &Hail::mesh_mm, 3)->at_least, mesh->at_least);
    }
}

TEST(HailField, HasTheStatesOfOtherProducts) {
    const std::vector<Cell> unseen(20, hail_unseen);
    std::vector<Cell> warm(20, Cell{});
    warm[1] = valued(65);  // at 1 km, below 0 C
    std::vector<Cell> cold(20, Cell{});
    cold[14] = valued(40);
    std::vector<Cell> folded = warm;
    folded[12] = hail_folded;
    const auto bricks = hail_columns({unseen, {}, warm, cold, folded});
    const FlatField field = map_of(bricks.view(), &Hail::mesh_mm).value();
    EXPECT_EQ(field.status[0], CellStatus::not_seen);
    EXPECT_EQ(field.status[1], CellStatus::no_echo);
    EXPECT_EQ(field.status[2], CellStatus::no_echo);
    EXPECT_EQ(field.status[3], CellStatus::no_echo);
    EXPECT_EQ(field.status[4], CellStatus::range_folded);
}

TEST(HailField, SaysWhereTheHailMayBeLarger) {
    std::vector<Cell> whole(20, Cell{});
    whole[13] = whole[14] = valued(55);
    std::vector<Cell> cut = whole, base = whole, away = whole, warm = whole;
    cut[15] = hail_unseen;
    base[12] = hail_folded;
    away[17] = hail_unseen;  // the echo ends below
    warm[0] = hail_unseen;
    std::vector<Cell> top(20, Cell{});
    top[19] = valued(55);
    const auto bricks = hail_columns({whole, cut, base, away, warm, top});
    const FlatField field = map_of(bricks.view(), &Hail::posh_percent).value();
    EXPECT_EQ(field.at_least, (std::vector<std::uint8_t>{0, 1, 1, 0, 0, 1}));
}

TEST(HailField, RefusesWhatHailNeeds) {
    const auto flat = bricks_of(storm_grid(small_spec(20, 1)));
    EXPECT_FALSE(map_of(flat.view(), &Hail::mesh_mm)) << "one level has no depth";
    const auto bricks = bricks_of(storm_grid(small_spec(20, 8)));
    EXPECT_FALSE(map_of(bricks.view(), &Hail::mesh_mm, 1, {5000, 2000}));
    EXPECT_FALSE(largest_hail(flat.view(), low_levels, 1));
}

TEST(LargestHail, IsTheLargestOfTheMapWithItsRange) {
    const auto bricks = bricks_of(storm_grid(small_spec(75, 37, 4000, 400)));
    const grid::BrickView view = bricks.view();
    const FlatField mesh = map_of(view, &Hail::mesh_mm).value();
    const auto largest = largest_hail(view, low_levels, 2).value().value();
    EXPECT_FLOAT_EQ(largest.mesh_mm, *std::ranges::max_element(mesh.values));
    const auto higher = map_of(view, &Hail::mesh_mm, 1, {2300, 5300}).value();
    EXPECT_LT(largest.range.least_mm, largest.mesh_mm);
    EXPECT_GT(largest.range.most_mm, largest.mesh_mm);
    EXPECT_LE(largest.range.least_mm, *std::ranges::max_element(higher.values) + 1e-4);
    const auto quiet = hail_columns({{}, {}});
    EXPECT_FALSE(largest_hail(quiet.view(), low_levels, 1).value());
}

TEST(HailSensitivity, IsWrittenForHailAlone) {
    const auto bricks = bricks_of(storm_grid(small_spec(75, 37, 4000, 400)));
    Scene scene;
    scene.product = Product::mesh;
    scene.freezing_levels = low_levels;
    const auto largest = largest_hail(bricks.view(), low_levels, 1).value().value();
    EXPECT_EQ(hail_sensitivity(bricks.view(), scene, 1).value(),
              fmt::format("heights 300 m off: MESH {:.1f} mm is {:.1f} to {:.1f} mm",
                          largest.mesh_mm, largest.range.least_mm, largest.range.most_mm));
    scene.product = Product::vil;
    EXPECT_EQ(hail_sensitivity(bricks.view(), scene, 1).value(), "");
    scene.product = Product::posh;
    EXPECT_EQ(hail_sensitivity(hail_columns({{}, {}}).view(), scene, 1).value(), "");
}

}  // namespace
}  // namespace stormcellar::render
