#include "render/products/smooth_field.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace stormcellar::render {
namespace {

using grid::CellStatus;

// Returns small multiples of 1/4, so that sums in float are exact enough.
float value_of_cell(int k) {
    return 20 + 0.25F * static_cast<float>((k * 37 + 11) % 61);
}

double cubic(double a, double b, double c, double d, double t) {
    return b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)));
}

// Applies the rule of render/products/smooth_field.h, for a place between the middle cells of a 4 x
// 4 field.
SmoothField::Place slowly(const FlatField& field, double x, double y) {
    const auto status = [&](int ix, int iy) { return field.status[field.index(ix, iy)]; };
    const double tx = x - 1, ty = y - 1;
    double weight = 0;
    bool all = true;
    for (int i = 1; i <= 2; ++i) {
        for (int j = 1; j <= 2; ++j) {
            if (status(i, j) == CellStatus::value) {
                weight += (i == 1 ? 1 - tx : tx) * (j == 1 ? 1 - ty : ty);
            } else if (status(i, j) != CellStatus::no_echo) {
                all = false;
            }
        }
    }
    const int near_x = tx >= 0.5 ? 2 : 1, near_y = ty >= 0.5 ? 2 : 1;
    CellStatus state = status(near_x, near_y);
    if (all) state = weight >= 0.5 ? CellStatus::value : CellStatus::no_echo;
    if (state != CellStatus::value) return {state, 0};
    std::vector<double> inner;
    double sum = 0;
    for (int i = 1; i <= 2; ++i) {
        for (int j = 1; j <= 2; ++j) {
            if (status(i, j) != CellStatus::value) continue;
            inner.push_back(static_cast<double>(field.values[field.index(i, j)]));
            sum += inner.back();
        }
    }
    const auto here = [&](int i, int j) {
        if (status(i, j) == CellStatus::value) {
            return static_cast<double>(field.values[field.index(i, j)]);
        }
        const int near_i = std::clamp(i, 1, 2), near_j = std::clamp(j, 1, 2);
        if (status(near_i, near_j) == CellStatus::value) {
            return static_cast<double>(field.values[field.index(near_i, near_j)]);
        }
        return sum / static_cast<double>(inner.size());
    };
    double rows[4];
    for (int j = 0; j < 4; ++j)
        rows[j] = cubic(here(0, j), here(1, j), here(2, j), here(3, j), tx);
    const double mixed = cubic(rows[0], rows[1], rows[2], rows[3], ty);
    const auto [least, largest] = std::ranges::minmax(inner);
    return {state, static_cast<float>(std::clamp(mixed, least, largest))};
}

FlatField field_of(unsigned inner, unsigned outer) {
    FlatField field(4, 4);
    for (int y = 0; y < 4; ++y) {
        for (int x = 0; x < 4; ++x) {
            const bool is_inner = x >= 1 && x <= 2 && y >= 1 && y <= 2;
            unsigned& pattern = is_inner ? inner : outer;
            // An outer cell only matters if it has a value.
            const unsigned states = is_inner ? 4 : 2;
            const unsigned state = pattern % states;
            pattern /= states;
            const CellStatus status = is_inner     ? static_cast<CellStatus>(state)
                                      : state == 1 ? CellStatus::value
                                                   : CellStatus::no_echo;
            field.put(field.index(x, y), status, value_of_cell(4 * y + x));
        }
    }
    return field;
}

// Tests 2^20 fields: all patterns of the four states in the four middle cells, and of value or no
// value in the twelve cells around them.
TEST(SmoothField, AgreesWithTheSlowFormForEveryPatternOfStates) {
    constexpr double places[][2] = {{1.25, 1.375}, {1.5, 1.5}, {1.875, 1.125}};
    std::size_t values = 0;
    for (unsigned inner = 0; inner < 256; ++inner) {
        for (unsigned outer = 0; outer < 4096; ++outer) {
            const FlatField field = field_of(inner, outer);
            const SmoothField smooth(field);
            const double* place = places[(inner + outer) % 3];
            const auto fast = smooth.at(place[0], place[1]);
            const auto slow = slowly(field, place[0], place[1]);
            ASSERT_EQ(fast.status, slow.status) << inner << " " << outer;
            ASSERT_NEAR(fast.value, slow.value, 2e-5) << inner << " " << outer;
            values += fast.status == CellStatus::value ? 1 : 0;
        }
    }
    EXPECT_GT(values, 200'000U);
}

TEST(SmoothField, IsTheCellAtItsCenterAndStaysBetweenTheCellsAround) {
    FlatField field(9, 7);
    for (std::size_t i = 0; i < field.values.size(); ++i) {
        const auto k = static_cast<int>(i);
        field.put(i, static_cast<CellStatus>((k * 7 + k / 5) % 4), value_of_cell(k));
    }
    const SmoothField smooth(field);
    for (int y = 0; y < 7; ++y) {
        for (int x = 0; x < 9; ++x) {
            const std::size_t cell = field.index(x, y);
            EXPECT_EQ(smooth.at(x, y).status, field.status[cell]);
            EXPECT_EQ(smooth.at(x, y).value, field.values[cell]);
        }
    }
    EXPECT_EQ(smooth.at(-0.5, -0.4).status, field.status[0]) << "cells at the edge are repeated";
    FlatField steep(4, 4);
    for (std::size_t i = 0; i < steep.values.size(); ++i)
        steep.put(i, CellStatus::value, i % 4 < 2 ? 10 : 60);
    for (double x = 0; x <= 3; x += 0.05) {
        const float value = SmoothField(steep).at(x, 1.3).value;
        EXPECT_GE(value, 10);
        EXPECT_LE(value, 60);
    }
}

TEST(SmoothField, OfOneCellIsThatCell) {
    FlatField field(1, 1);
    field.put(0, CellStatus::value, 33);
    EXPECT_EQ(SmoothField(field).at(0.3, -0.2).value, 33);
}

TEST(SmoothField, IsForMapsOfValuesThatDoNotWrap) {
    Scene scene;
    scene.smooth = true;
    EXPECT_FALSE(is_smoothed(scene)) << "a volume is not a map";
    scene.product = Product::composite;
    EXPECT_TRUE(is_smoothed(scene));
    scene.moment = level2::Moment::vel;
    EXPECT_FALSE(is_smoothed(scene));
    scene.moment = level2::Moment::ref;
    scene.product = Product::lowest_seen;
    EXPECT_FALSE(is_smoothed(scene));
}

}  // namespace
}  // namespace stormcellar::render
