#include "stormcellar/grid/brick_view.h"

#include <array>
#include <set>
#include <vector>

#include <gtest/gtest.h>

namespace stormcellar::grid {
namespace {

BrickView view_of(int bricks_x, int bricks_y, int bricks_z) {
    BrickView view;
    view.bricks_x = bricks_x;
    view.bricks_y = bricks_y;
    view.bricks_z = bricks_z;
    return view;
}

TEST(BrickView, EveryCellHasAPlaceOfItsOwn) {
    const BrickView view = view_of(2, 3, 2);
    std::vector<bool> taken(2 * 3 * 2 * brick_cells, false);
    for (int ix = 0; ix < 32; ++ix) {
        for (int iy = 0; iy < 48; ++iy) {
            for (int iz = 0; iz < 32; ++iz) {
                const std::size_t offset =
                    view.offset_x(ix) + view.offset_y(iy) + view.offset_z(iz);
                ASSERT_LT(offset, taken.size());
                ASSERT_FALSE(taken[offset]);
                taken[offset] = true;
            }
        }
    }
}

TEST(BrickView, HeightRunsFastest) {
    const BrickView view = view_of(2, 3, 2);
    EXPECT_EQ(view.offset_z(1), 1U);
    EXPECT_EQ(view.offset_y(1), 16U);
    EXPECT_EQ(view.offset_x(1), 256U);
    EXPECT_EQ(view.offset_z(16), brick_cells);
    EXPECT_EQ(view.offset_y(16), 2 * brick_cells);
    EXPECT_EQ(view.offset_x(16), 6 * brick_cells);
}

TEST(BrickView, ReadsEachKindOfBrick) {
    std::vector<std::byte> codes(3 * brick_cells * 2);
    codes[2 * (2 * brick_cells + 5)] = std::byte{0x2C};  // little-endian 300 in the third brick
    codes[2 * (2 * brick_cells + 5) + 1] = std::byte{0x01};
    codes[2 * (2 * brick_cells + 6)] = std::byte{2};
    std::vector<std::byte> states(brick_cells / 4);
    states[0] = std::byte{0b10'01'00'01};
    std::array<BrickEntry, 3> bricks{};
    bricks[0].uniform_status = CellStatus::no_echo;
    bricks[1].kind = BrickKind::status_only;
    bricks[2].kind = BrickKind::stored;
    BrickView view = view_of(1, 1, 3);
    view.quantization = {2, -10, 0.5F};
    view.codes = codes;
    view.states = states;
    view.bricks = bricks;

    EXPECT_EQ(view.status(15, 15, 15), CellStatus::no_echo);
    EXPECT_EQ(view.status(0, 0, 16), CellStatus::no_echo);
    EXPECT_EQ(view.status(0, 0, 17), CellStatus::not_seen);
    EXPECT_EQ(view.status(0, 0, 18), CellStatus::no_echo);
    EXPECT_EQ(view.status(0, 0, 19), CellStatus::range_folded);
    EXPECT_EQ(view.status(0, 0, 37), CellStatus::value);
    EXPECT_EQ(view.value(0, 0, 37), -10 + 0.5F * 297);
    EXPECT_EQ(view.status(0, 0, 38), CellStatus::range_folded);
    EXPECT_EQ(view.status(0, 0, 39), CellStatus::not_seen);

    codes[2 * (2 * brick_cells + 7)] = std::byte{3};
    EXPECT_EQ(view.status(0, 0, 39), CellStatus::value);
    view.quantization.has_ambiguous = true;
    EXPECT_EQ(view.status(0, 0, 39), CellStatus::ambiguous);
    EXPECT_EQ(view.status(0, 0, 37), CellStatus::value);
    EXPECT_EQ(view.value(0, 0, 37), -10 + 0.5F * 297) << "codes mean the same values";
}

TEST(Quantization, StepsAreNoCoarserThanTheRadarsOwn) {
    // The step of the radar's finest coding of each moment (ICD 2620002 table XVII-I and real
    // files), and the range of values that must fit.
    struct Coding {
        level2::Moment moment;
        double step, least, largest;
    };
    for (const Coding& radar :
         {Coding{level2::Moment::ref, 0.5, -32, 94}, Coding{level2::Moment::vel, 0.5, -127, 126},
          Coding{level2::Moment::sw, 0.5, 0, 63}, Coding{level2::Moment::zdr, 1 / 32.0, -13, 20},
          Coding{level2::Moment::phi, 0.3526, 0, 360},
          Coding{level2::Moment::rho, 1 / 300.0, 0.2, 1.06},
          Coding{level2::Moment::veld, 0.5, -320, 320}}) {
        const Quantization q = default_quantization(radar.moment);
        EXPECT_LE(q.step, radar.step) << level2::moment_name(radar.moment);
        EXPECT_LE(q.value_of(q.first_code()), radar.least) << level2::moment_name(radar.moment);
        EXPECT_GE(q.value_of(q.largest_code()), radar.largest) << level2::moment_name(radar.moment);
    }
}

TEST(CellStatus, NamesDiffer) {
    std::set<std::string_view> names;
    for (std::size_t status = 0; status < cell_status_count; ++status)
        names.insert(cell_status_name(static_cast<CellStatus>(status)));
    EXPECT_EQ(names.size(), cell_status_count);
}

TEST(CellStatus, OnlyCellsOfDerivedMomentsAreAmbiguous) {
    const std::vector<CellStatus> measured = {CellStatus::not_seen, CellStatus::no_echo,
                                              CellStatus::range_folded, CellStatus::value};
    std::vector<CellStatus> derived = measured;
    derived.push_back(CellStatus::ambiguous);
    for (const level2::MomentFacts& facts : level2::moment_facts) {
        EXPECT_EQ(states_of(facts.moment), facts.is_derived ? derived : measured) << facts.name;
        EXPECT_EQ(default_quantization(facts.moment).has_ambiguous, facts.is_derived) << facts.name;
    }
}

}  // namespace
}  // namespace stormcellar::grid
