#include "render/volume/block_codes.h"

#include <algorithm>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "stormcellar/grid/brick_view.h"

namespace stormcellar::render {
namespace {

// Returns random codes of a brick. Some rows have no values; in the other rows, a third of the
// cells have values. One cell has the largest code.
template <class Code>
std::vector<Code> random_codes(unsigned seed) {
    std::mt19937 random(seed);
    std::vector<Code> codes(grid::brick_cells);
    for (std::size_t i = 0; i < codes.size(); ++i) {
        const bool has_value = (i / 8) % 5 != 0 && random() % 3 == 0;
        codes[i] = static_cast<Code>(has_value ? grid::first_value_code + random() % 60
                                               : random() % grid::first_value_code);
    }
    codes[1234] = std::numeric_limits<Code>::max();
    return codes;
}

template <class Code>
void expect_blocks(int edge) {
    const auto codes = random_codes<Code>(static_cast<unsigned>(edge));
    BlockCodes found;
    find_block_codes(reinterpret_cast<const std::byte*>(codes.data()), sizeof(Code), edge, found);
    const int across = grid::brick_edge / edge;
    ASSERT_EQ(found.across, across);
    for (int block = 0; block < across * across * across; ++block) {
        const int x = block / (across * across), y = block / across % across, z = block % across;
        int least = 1 << 20, largest = -1;
        for (int cell = 0; cell < edge * edge * edge; ++cell) {
            const int cx = x * edge + cell / (edge * edge), cy = y * edge + cell / edge % edge;
            const int at = (cx * grid::brick_edge + cy) * grid::brick_edge + z * edge + cell % edge;
            const int code = codes[static_cast<std::size_t>(at)];
            if (code < grid::first_value_code) continue;
            least = std::min(least, code);
            largest = std::max(largest, code);
        }
        const auto at = static_cast<std::size_t>(block);
        if (largest < 0) {
            EXPECT_LT(found.largest[at], grid::first_value_code) << edge << ' ' << block;
        } else {
            EXPECT_EQ(found.least[at], least) << edge << ' ' << block;
            EXPECT_EQ(found.largest[at], largest) << edge << ' ' << block;
        }
    }
}

TEST(BlockCodes, AreTheRangeOfTheValuesInEachBlock) {
    for (const int edge : {2, 4, 8, 16}) {
        expect_blocks<std::uint8_t>(edge);
        expect_blocks<std::uint16_t>(edge);
    }
}

}  // namespace
}  // namespace stormcellar::render
