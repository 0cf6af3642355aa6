#include "retrieve/dealias/minimum_cut.h"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

namespace stormcellar::retrieve {
namespace {

struct Cost {
    std::int32_t from, to;
    float cost;
};

// Tries every way to cut random graphs of ten nodes.
TEST(MinimumCut, IsNoDearerThanAnyOther) {
    std::mt19937 random(3);
    std::uniform_int_distribution<std::int32_t> node(0, 9);
    std::uniform_real_distribution<float> weight(-4, 4);
    for (int round = 0; round < 200; ++round) {
        std::array<float, 10> prefers{};
        std::vector<Cost> costs;
        MinimumCut cut(10, 20);
        for (std::int32_t i = 0; i < 10; ++i) {
            prefers[static_cast<std::size_t>(i)] = weight(random);
            cut.prefer_source(i, prefers[static_cast<std::size_t>(i)]);
        }
        for (int i = 0; i < 20; ++i) {
            const Cost one{node(random), node(random), std::abs(weight(random))};
            const Cost reverse{one.to, one.from, i % 2 == 0 ? 0 : std::abs(weight(random))};
            costs.push_back(one);
            costs.push_back(reverse);
            cut.connect(one.from, one.to, one.cost, reverse.cost);
        }
        const auto cost_of = [&](unsigned on_source) {
            float sum = 0;
            for (unsigned i = 0; i < 10; ++i) {
                const bool is_source = (on_source >> i & 1U) != 0;
                sum += is_source ? std::max(0.0F, -prefers[i]) : std::max(0.0F, prefers[i]);
            }
            for (const Cost& one : costs) {
                if ((on_source >> one.from & 1U) != 0 && (on_source >> one.to & 1U) == 0)
                    sum += one.cost;
            }
            return sum;
        };
        cut.run(1'000'000);
        unsigned found = 0;
        for (std::int32_t i = 0; i < 10; ++i)
            if (cut.on_source_side(i)) found |= 1U << i;
        float least = cost_of(0);
        for (unsigned other = 1; other < 1024; ++other)
            least = std::min(least, cost_of(other));
        EXPECT_NEAR(cost_of(found), least, 1e-3F);
    }
}

}  // namespace
}  // namespace stormcellar::retrieve
