#include "render/volume/corner_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "render/color/built_in_tables.h"
#include "render/volume/ray_maker.h"
#include "render/volume/ray_packet.h"
#include "tests/render/synthetic_storm.h"

namespace stormcellar::render {
namespace {

// Returns the expected word of a cell, from its four codes. Bricks without values count as zeros.
std::uint32_t expected_word(const grid::BrickView& view, int x, int y, int z) {
    const grid::GridSpec& spec = *view.spec;
    std::uint32_t word = 0;
    for (int c = 0; c < 4; ++c) {
        const int cx = std::min(x + c % 2, spec.nx - 1), cy = std::min(y + c / 2, spec.ny - 1);
        const int cz = std::min(z, spec.nz() - 1);
        const int edge = grid::brick_edge;
        const std::size_t brick = view.brick_index(cx / edge, cy / edge, cz / edge);
        if (view.bricks[brick].kind != grid::BrickKind::stored) continue;
        if (view.bricks[brick].value_count == 0) continue;
        const int cell = ((cx % edge) * edge + cy % edge) * edge + cz % edge;
        const std::size_t at = brick * grid::brick_cells + static_cast<std::size_t>(cell);
        const auto code = static_cast<std::uint8_t>(view.codes[at]);
        word |= static_cast<std::uint32_t>(code) << (8 * c);
    }
    return word;
}

void expect_filled(const CornerTable& table, const grid::BrickView& view) {
    const grid::GridSpec& spec = *view.spec;
    std::size_t wrong = 0, values = 0;
    for (int x = 0; x < spec.nx; ++x) {
        for (int y = 0; y < spec.ny; ++y) {
            for (int z = 0; z <= spec.nz(); ++z) {
                std::uint32_t word = 0;
                std::memcpy(&word,
                            table.words() + (std::ptrdiff_t{x} * table.stride_x() +
                                             std::ptrdiff_t{y} * table.stride_y() + z) *
                                                4,
                            sizeof word);
                wrong += word != expected_word(view, x, y, z) ? 1 : 0;
                values += (word & 0xFF) >= grid::first_value_code ? 1 : 0;
            }
        }
    }
    EXPECT_EQ(wrong, 0U);
    EXPECT_GT(values, 100U);
}

// Returns a ball of echo with a hard rim. Outside the ball, cells below its middle were not seen,
// and all other cells are clear air.
grid::BrickGrid ball_at(const grid::GridSpec& spec, double x, double y, double z) {
    return bricks_of(make_grid_of(spec, [&](int ix, int iy, int iz) {
        const double r = std::hypot(ix - x, iy - y, iz - z);
        if (r < 9) return valued(20 + 3 * (9 - r));
        return iz < z ? Cell{grid::CellStatus::not_seen, 0} : Cell{};
    }));
}

TEST(CornerTable, HoldsTheFourColumnsOfEachCell) {
    const grid::GridSpec spec = small_spec(50, 21);
    for (const double x : {3.0, 15.5, 31.0, 47.0}) {
        const auto ball = ball_at(spec, x, 40, 12);
        CornerTable table;
        table.fill(ball.view(), 3);
        expect_filled(table, ball.view());
    }
}

// The balls are at different places; the table must keep nothing of the previous ball.
TEST(CornerTable, ForgetsTheGridBefore) {
    const grid::GridSpec spec = small_spec(50, 36);
    const auto first = ball_at(spec, 10, 10, 28);
    const auto second = ball_at(spec, 40, 33, 8);
    CornerTable table;
    for (const grid::BrickGrid* ball : {&first, &second, &first}) {
        table.fill(ball->view(), 2);
        expect_filled(table, ball->view());
    }
}

TEST(CornerTable, ServesWhereSamplesAreMany) {
    const auto ball = ball_at(small_spec(50, 21), 20, 20, 10);
    const double cells = 50.0 * 50 * 21;
    EXPECT_TRUE(CornerTable::serves(ball.view(), 12 * cells));
    EXPECT_FALSE(CornerTable::serves(ball.view(), 11 * cells));
    const auto fine = grid::BrickGrid::from(
        make_grid_of(small_spec(50, 21), [](int, int, int) { return valued(30); }),
        {2, -32, 0.01F});
    EXPECT_FALSE(CornerTable::serves(fine.view(), 100 * cells));
}

TEST(CornerTable, RaysFindWhatTheyFindInTheBricks) {
    const grid::GridSpec spec = small_spec(50, 36);
    const auto ball = ball_at(spec, 15.5, 31, 16);
    CornerTable table;
    table.fill(ball.view(), 1);
    const ViewGeometry geometry(spec, {163, 48, 1.3}, 1, 64, 48);
    constexpr int slices = 64;
    const LevelPosition levels(spec, 1);
    const TransferFunction transfer(nws_reflectivity(), ball.view().quantization, 4,
                                    (geometry.far_m() - geometry.near_m()) / slices,
                                    Integration::second_order);
    const RayMaker maker(spec, geometry, levels, slices);
    const std::uint64_t all_steps = ~std::uint64_t{0};
    PacketVolume bricks(ball.view(), levels, transfer);
    PacketVolume words = bricks;
    words.use(table);
    float most = 0;
    for (int y = 0; y < 48; ++y) {
        for (int x = 0; x < 64; x += packet_rays) {
            std::array<PixelPlace, packet_rays> pixels;
            for (int i = 0; i < packet_rays; ++i)
                pixels[static_cast<std::size_t>(i)] = {x + i, y};
            const RayPacket rays = maker.packet(pixels);
            std::array<float, 4 * packet_rays> from_bricks, from_words;
            cast_packet(bricks, rays, &all_steps, 1, from_bricks.data(), nullptr);
            cast_packet(words, rays, &all_steps, 1, from_words.data(), nullptr);
            EXPECT_EQ(from_bricks, from_words) << x << ' ' << y;
            most = std::max(most, from_words[3]);
        }
    }
    EXPECT_GT(most, 0.2F);
}

}  // namespace
}  // namespace stormcellar::render
