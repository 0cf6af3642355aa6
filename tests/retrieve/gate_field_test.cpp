#include "retrieve/quality/gate_field.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace stormcellar::retrieve {
namespace {

// A field whose gates have a code with a probability of 70 % up to an end that differs from radial
// to radial; one radial has no such gates.
GateField random_field(bool is_circle) {
    std::mt19937 random(7);
    GateField field;
    field.radials = 13;
    field.gates = 157;
    field.gate_spacing_m = 250;
    field.scale = 2;
    field.offset = 66;
    field.is_circle = is_circle;
    for (std::size_t radial = 0; radial < field.radials; ++radial) {
        std::size_t& end = field.ends.emplace_back(0);
        for (std::size_t gate = 0; gate < field.gates; ++gate) {
            const bool has_code = gate < radial * 29 % 160 && random() % 10 < 7;
            field.codes.push_back(has_code ? static_cast<std::uint16_t>(2 + random() % 120)
                                           : std::uint16_t{0});
            if (has_code) end = gate + 1;
        }
    }
    return field;
}

struct Expected {
    double sum = 0;
    int count = 0;
};

// Sums `number(radial, gate)` over a box, one gate after the other. Negative numbers do not count.
template <class Number>
Expected sum_box(const GateField& field, const GateBox& box, int radial, int gate, Number number) {
    Expected expected;
    const int radials = static_cast<int>(field.radials);
    for (int r = radial - box.radials / 2; r <= radial + box.radials / 2; ++r)
        for (int g = gate - box.gates / 2; g <= gate + box.gates / 2; ++g) {
            const bool is_inside = g >= 0 && g < static_cast<int>(field.gates) &&
                                   (field.is_circle || (r >= 0 && r < radials));
            if (!is_inside) continue;
            const double value = number((r + radials) % radials, g);
            if (value < 0) continue;
            expected.sum += value;
            ++expected.count;
        }
    return expected;
}

template <class Visit>
void visit_sums(const GateField& field, BoxSums sums, Visit visit) {
    for (std::size_t radial = 0; radial < field.radials; ++radial)
        visit(radial, sums.next());
}

template <class Number>
void expect_sums(const GateField& field, const GateBox& box, Number number, std::size_t radial,
                 const std::uint32_t* sums) {
    for (std::size_t gate = 0; gate < field.gates; ++gate) {
        const Expected expected =
            sum_box(field, box, static_cast<int>(radial), static_cast<int>(gate), number);
        const BoxSum found(sums[gate]);
        ASSERT_EQ(found.count(), static_cast<float>(expected.count)) << radial << " " << gate;
        if (expected.count == 0) {
            EXPECT_TRUE(std::isnan(found.mean()));
        } else {
            EXPECT_FLOAT_EQ(found.mean(), static_cast<float>(expected.sum / expected.count))
                << radial << " " << gate;
        }
    }
}

double code_at(const GateField& field, int radial, int gate) {
    const auto at = static_cast<std::size_t>(radial) * field.gates + static_cast<std::size_t>(gate);
    return field.codes[at] != 0 ? field.codes[at] : -1.0;
}

TEST(GateField, SumsOfCodesAreThoseOfEachBox) {
    for (const bool is_circle : {false, true})
        for (const GateBox box : {GateBox{3, 5}, GateBox{9, 33}, GateBox{1, 3}, GateBox{11, 79}}) {
            const GateField field = random_field(is_circle);
            std::size_t visited = 0;
            visit_sums(field, BoxSums::of_codes(field, box),
                       [&](std::size_t radial, const std::uint32_t* sums) {
                           EXPECT_EQ(radial, visited++);
                           expect_sums(
                               field, box, [&](int r, int g) { return code_at(field, r, g); },
                               radial, sums);
                       });
            EXPECT_EQ(visited, field.radials);
        }
}

TEST(GateField, SumsOfDifferencesAreThoseOfEachBoxAlsoOnACircle) {
    const GateBox box{3, 7};
    for (const bool is_circle : {false, true})
        for (const float turn : {0.0F, 50.0F}) {
            const GateField field = random_field(is_circle);
            // Squared differences in codes; half a code is half a unit.
            const auto squared = [&](double a, double b) {
                if (a < 0 || b < 0) return -1.0;
                double apart = std::abs(a - b);
                if (turn > 0) apart = std::min(apart, std::abs(100 - apart));
                return apart * apart;
            };
            const auto along = [&](int r, int g) {
                return g == 0 ? -1.0 : squared(code_at(field, r, g), code_at(field, r, g - 1));
            };
            const auto across = [&](int r, int g) {
                if (r == 0 && !is_circle) return -1.0;
                const int before = r == 0 ? static_cast<int>(field.radials) - 1 : r - 1;
                return squared(code_at(field, r, g), code_at(field, before, g));
            };
            visit_sums(field, BoxSums::of_differences(field, box, Direction::range, turn),
                       [&](std::size_t radial, const std::uint32_t* sums) {
                           expect_sums(field, box, along, radial, sums);
                       });
            visit_sums(field, BoxSums::of_differences(field, box, Direction::azimuth, turn),
                       [&](std::size_t radial, const std::uint32_t* sums) {
                           expect_sums(field, box, across, radial, sums);
                       });
        }
}

TEST(GateField, LargeNumbersOfALargeBoxDoNotOverflow) {
    GateField field = random_field(true);
    for (std::size_t i = 0; i < field.codes.size(); ++i)
        field.codes[i] = i % 2 == 0 ? 65535 : 2;
    field.ends.assign(field.radials, field.gates);
    const GateBox box{9, 33};
    const auto most = static_cast<float>(BoxSum::most_sum / 297);
    visit_sums(field, BoxSums::of_codes(field, box), [&](std::size_t, const std::uint32_t* sums) {
        const BoxSum middle(sums[field.gates / 2]);
        EXPECT_EQ(middle.count(), 297);
        EXPECT_LE(middle.mean(), most);
    });
    visit_sums(field, BoxSums::of_differences(field, box, Direction::range, 0),
               [&](std::size_t, const std::uint32_t* sums) {
                   const BoxSum middle(sums[field.gates / 2]);
                   EXPECT_EQ(middle.count(), 297);
                   EXPECT_NEAR(middle.mean(), most, 0.02F * most);
               });
}

TEST(GateField, BoxesHaveAnOddNumberOfGatesAboutTheirLength) {
    GateField field = random_field(false);
    EXPECT_EQ(gate_box(3, 1750, field).gates, 7);
    field.gate_spacing_m = 1000;
    EXPECT_EQ(gate_box(3, 1750, field).gates, 3);
    EXPECT_EQ(gate_box(9, 8250, field).gates, 9);
    field.gate_spacing_m = 1;
    EXPECT_EQ(gate_box(3, 1750, field).gates, 81);
}

}  // namespace
}  // namespace stormcellar::retrieve
