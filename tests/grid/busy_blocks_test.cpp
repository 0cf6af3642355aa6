// Tests is_quiet() against a search of every code.
#include "grid/sweep/busy_blocks.h"

#include <algorithm>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace stormcellar::grid {
namespace {

constexpr std::int32_t gates_a_block = 32;

// Searches whole blocks, as BusyBlocks does.
bool is_quiet(const std::vector<std::uint8_t>& codes, std::int32_t first, std::int32_t last) {
    const std::int32_t first_gate = first / gates_a_block * gates_a_block;
    const std::int32_t end_gate = (last / gates_a_block + 1) * gates_a_block;
    const auto from = static_cast<std::size_t>(first_gate);
    const auto to = static_cast<std::size_t>(end_gate);
    for (std::size_t gate = from; gate < std::min(to, codes.size()); ++gate) {
        if (codes[gate] != 0) return false;
    }
    return true;
}

TEST(BusyBlocks, AreThoseThatHoldAnythingButZero) {
    std::mt19937_64 random(12);
    // Numbers of gates around blocks of 32 gates and words of 2048 gates.
    for (const std::size_t gates : {1, 31, 32, 33, 460, 1832, 2047, 2048, 2049, 4100}) {
        std::vector<std::vector<std::uint8_t>> rows(5, std::vector<std::uint8_t>(gates));
        rows[1][gates - 1] = 1;
        rows[2][0] = 255;
        for (int i = 0; i < 3; ++i)
            rows[3][random() % gates] = 2;
        rows[4].resize(gates / 2);  // a radial that ends early
        if (!rows[4].empty()) rows[4].back() = 66;
        BusyBlocks blocks(rows.size(), gates);
        for (std::size_t row = 0; row < rows.size(); ++row)
            blocks.mark(row, rows[row]);
        for (int i = 0; i < 3000; ++i) {
            const auto one = static_cast<std::int32_t>(random() % gates);
            const auto other = static_cast<std::int32_t>(random() % gates);
            const auto [first, last] = std::minmax(one, other);
            for (std::size_t row = 0; row < rows.size(); ++row) {
                ASSERT_EQ(blocks.is_quiet(row, BusyBlocks::blocks_of(first, last)),
                          is_quiet(rows[row], first, last))
                    << gates << " gates, row " << row << ", " << first << " to " << last;
            }
        }
    }
    EXPECT_TRUE(BusyBlocks().is_empty());
}

}  // namespace
}  // namespace stormcellar::grid
